# SPDX-License-Identifier: GPL-3.0-or-later
"""`--fit` on the command line: its options, and reading of scans and cages."""

import argparse
from dataclasses import replace
from pathlib import Path

import bpy

from ..blender import Object, current_context
from ..core import tolerance
from ..jobs.fit import Fit
from ..jobs.scan_cage import make_cage
from ..mesh.read import read_mesh
from ..mesh.scans import read_scans
from ..settings import Settings
from .files import FileError, read_file
from .places import require_format
from .rna import number, option, refuse

_CAGE_FACES = 300
# options that a fit decides itself, or that have another meaning there
_NOT_HERE = ("energy", "interpolation", "limit", "tolerance_group", "pull_group", "pad_size")


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("from scans to surfaces")
    group.add_argument(
        "--fit",
        action="store_true",
        help="IN has scans, meshes or points: write the fairest surface near them. With --tolerance the calmest one "
        "that 95 %% of the points are within; otherwise as close as the noise allows [off]",
    )
    group.add_argument(
        "--cage",
        type=Path,
        metavar="FILE",
        help="OBJ, PLY or STL file with the mesh to draw to the scan [one is made by QuadriFlow]",
    )
    group.add_argument(
        "--cage-faces",
        type=number(int, 6, 100_000),
        metavar="N",
        help=f"faces of the cage that is made, about [{_CAGE_FACES}]",
    )


def check(arguments: argparse.Namespace, settings: Settings) -> None:
    """Raises ValueError for contradictory options."""
    if not arguments.fit:
        refuse(arguments, "--fit", "cage", "cage_faces")
        return
    for name in _NOT_HERE:
        if name in vars(arguments):
            raise ValueError(f"{option(name)} is not for --fit, which moves all vertices by itself")
    if arguments.clean:
        raise ValueError("--clean is not for --fit: call twice")
    if arguments.cage is not None and arguments.cage_faces is not None:
        raise ValueError("give one of --cage and --cage-faces: a cage has its own faces")
    if arguments.cage is not None:
        require_format(arguments.cage)
    if "tolerance" in vars(arguments) and not settings.tolerance > 0:
        raise ValueError("--tolerance of --fit must be over 0")


def read(arguments: argparse.Namespace, settings: Settings) -> tuple[list[Object], Fit]:
    """The cage, alone in the scene, and its Fit."""
    scans, context = read_file(arguments.input), current_context()
    scan = read_scans(context, scans)
    if arguments.cage is not None:
        cages = read_file(arguments.cage)
        if len(cages) > 1:
            raise FileError(f"{arguments.cage} has {len(cages)} meshes: join them, a cage is one.")
    elif not len(scan.triangles):
        raise FileError(
            f"{arguments.input} has points without faces: draw a cage, and give it as --cage."
        )
    else:
        name = scans[0].name
        cages = [make_cage(context, scans, arguments.cage_faces or _CAGE_FACES).object]
        for one in scans:
            bpy.data.objects.remove(one)
        cages[0].name = name
    if "tolerance" not in vars(arguments):
        return cages, Fit(scan)
    length = tolerance(
        replace(settings, interpolation="APPROXIMATE"), read_mesh(cages[0].data).mean_edge_length
    )
    return cages, Fit(scan, length)
