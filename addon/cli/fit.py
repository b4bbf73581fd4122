# SPDX-License-Identifier: GPL-3.0-or-later
"""`--fit` on the command line: its options, reading of scans and cages, and the entries of the report."""

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy

from ..blender import Object, current_context
from ..cad import words
from ..cad.fit import PatchJob
from ..mesh.read import read_mesh
from ..mesh.scans import read_scans
from ..scan_cage import make_cage
from ..scan_fit import Fit, FitJob
from ..settings import Settings
from .files import FileError, read_file
from .places import FORMATS, Place, file_format
from .rna import option, whole_number

_CAGE_FACES = 300
# options that a fit decides itself, or that have another meaning there
_NOT_HERE = ("energy", "interpolation", "limit", "tolerance_group", "pull_group", "pad_size")


@dataclass(frozen=True)
class FitOptions:
    cage: Path | None  # None: a cage is made
    cage_faces: int
    tolerance: float | None
    is_share: bool  # relative to the mean edge of the cage

    def fit(self, cage: Object, scan: Any) -> Fit:
        """The Fit for a cage that has been read."""
        tolerance = self.tolerance
        if tolerance is not None and self.is_share:
            tolerance *= read_mesh(cage.data).mean_edge_length
        return Fit(scan, tolerance)


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("from scans to surfaces")
    group.add_argument(
        "--fit",
        action="store_true",
        help="IN are scans, meshes or points: write the fairest surface near each. With --tolerance the calmest one "
        "that 95 %% of the points are within; otherwise as close as the noise allows [off]",
    )
    group.add_argument(
        "--cage",
        metavar="FILE",
        help="OBJ, PLY or STL file with the mesh to draw to the scan [one is made by QuadriFlow]",
    )
    group.add_argument(
        "--cage-faces",
        type=whole_number(6, 100_000),
        metavar="N",
        help=f"faces of the cage that is made, about [{_CAGE_FACES}]",
    )


def options_of(arguments: argparse.Namespace, settings: Settings) -> FitOptions | None:
    """From the arguments; None without `--fit`. Raises ValueError for contradictory options."""
    if not arguments.fit:
        for name in ("cage", "cage_faces"):
            if getattr(arguments, name) is not None:
                raise ValueError(f"{option(name)} needs --fit")
        return None
    for name in _NOT_HERE:
        if name in vars(arguments):
            raise ValueError(f"{option(name)} is not for --fit, which moves all vertices by itself")
    for name in ("fill", "clean"):
        if getattr(arguments, name):
            raise ValueError(f"{option(name)} is not for --fit: call twice")
    if arguments.cage is not None and arguments.cage_faces is not None:
        raise ValueError("give one of --cage and --cage-faces: a cage has its own faces")
    cage = None if arguments.cage is None else Path(arguments.cage)
    if cage is not None and file_format(cage) not in FORMATS:
        raise ValueError(f"{cage} is no cage: give an OBJ, PLY or STL file")
    is_said = "tolerance" in vars(arguments)
    if is_said and not settings.tolerance > 0:
        raise ValueError("--tolerance of --fit must be over 0")
    return FitOptions(
        cage,
        arguments.cage_faces or _CAGE_FACES,
        settings.tolerance if is_said else None,
        settings.tolerance_unit == "RELATIVE",
    )


def shown(options: FitOptions | None) -> dict[str, Any]:
    if options is None:
        return {}
    return {
        "cage": None if options.cage is None else str(options.cage),
        "cage_faces": options.cage_faces if options.cage is None else None,
        "fit_tolerance": options.tolerance,
    }


def read(file: Place, options: FitOptions, merge: bool) -> tuple[list[Object], Fit]:
    """The cage, alone in the scene, and its Fit."""
    scans, context = read_file(file.source, merge), current_context()
    scan = read_scans(context, scans)
    if options.cage is not None:
        cages = read_file(options.cage, merge)
        if len(cages) > 1:
            raise FileError(
                "SEVERAL", f"{options.cage} has {len(cages)} meshes: join them, a cage is one."
            )
    elif not len(scan.triangles):
        raise FileError(
            "NO_CAGE",
            f"{file.source} has points without faces: draw a cage, and give it as --cage.",
        )
    else:
        name = scans[0].name
        cages = [make_cage(context, scans, options.cage_faces).object]
        for one in scans:
            bpy.data.objects.remove(one)
        cages[0].name = name
    return cages, options.fit(cages[0], scan)


def entry(job: FitJob | PatchJob) -> dict[str, Any]:
    """Distances between the scan and a finished job's surface or patches."""
    found = job.result
    near = job.from_scan if isinstance(job, PatchJob) else found.within
    own = {}
    if isinstance(job, PatchJob):
        own = {"off_allowed": job.allowed, "angle_allowed": job.patches.normal_tolerance}
    return own | {
        "points": len(found.distances),
        "within": near[0],
        "largest": near[1],
        "noise": found.noise,
        "weight": found.weight,
        "too_coarse": found.too_coarse.tolist(),
        "outliers": len(found.outliers),
    }


def said(told: dict[str, Any]) -> str:
    """For example `within 0.42 of 95 % of 26,000 points, largest 0.9; noise about 0.4`."""
    text = (
        f"within {words.short(told['within'])} of 95 % of {told['points']:,} points, "
        f"largest {words.short(told['largest'])}; noise about {words.short(told['noise'])}"
    )
    coarse = len(told["too_coarse"])
    return text + (f"; {coarse} faces of the cage are too coarse" if coarse else "")
