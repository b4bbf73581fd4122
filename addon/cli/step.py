# SPDX-License-Identifier: GPL-3.0-or-later
"""CAD files on the command line: their options, writing, and the entries of the report."""

import argparse
from collections.abc import Sequence
from typing import Any

from ..cad import words
from ..cad.fit import PatchJob, refused
from ..errors import JobError
from ..settings import PatchOptions, Settings
from .places import Place, is_cad
from .rna import OfOperator, option

_OPTIONS = OfOperator(
    "export_scene.fairing_step",
    {},
    fit_tolerance="fit_tolerance",
    fit_angle="fit_angle",
    unit="unit",
    force="force",
)


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("files for CAD (OUT ends in .step or .stp)")
    _OPTIONS.add(group)


def options_of(
    arguments: argparse.Namespace, settings: Settings, files: Sequence[Place]
) -> PatchOptions | None:
    """The options for CAD files; None if none is written. Raises ValueError for options that need one."""
    if not any(is_cad(file.target) for file in files):
        for name in _OPTIONS.names:
            if getattr(arguments, name) is not None:
                raise ValueError(f"{option(name)} needs an output that ends in .step")
        return None
    levels = settings.levels if "levels" in vars(arguments) else 0
    return PatchOptions(fit_levels=levels, **_OPTIONS.said(arguments))


def require_patches(jobs: Sequence[PatchJob]) -> None:
    faulty = refused(jobs)
    if faulty:
        raise JobError(
            words.together(job.warnings()[0] for job in faulty) + " --force writes them red.",
            "UNRESOLVED",
            "face",
            faulty[0].refused,
        )


def object_entry(job: PatchJob) -> dict[str, Any]:
    patches = job.patches
    closed = int(patches.shell_closed.sum())
    return {
        "name": job.name,
        "control": {
            "vertices": len(job.arrays.positions),
            "faces": len(job.arrays.face_sizes),
        },
        "result": {
            "patches": len(patches),
            "solids": closed,
            "shells": len(patches.shell_closed) - closed,
        },
        "report": {
            "levels": patches.levels,
            "size": patches.size,
            "off": job.off,
            "largest_angle": job.angle,
            "spans": int(patches.patch_spans.prod(axis=1).sum()),
            "unmet": patches.unmet.tolist(),
            "unresolved": patches.unresolved.tolist(),
        },
    }
