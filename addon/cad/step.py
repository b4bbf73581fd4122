# SPDX-License-Identifier: GPL-3.0-or-later
"""Finished jobs as one file for CAD, and what is said about it."""

from collections.abc import Sequence

from .. import core
from . import colours, words
from .fit import PatchJob
from .settings import METRES

# errors are told in millimetres where the file is metric
_TOLD = {"IN": ("in", "IN"), "FT": ("in", "IN")}


def why_not(path: str) -> str:
    """Why no file of that name can be written, as a sentence; empty where it can."""
    if _is_rhino(path) and not core.why_missing() and not core.module().can_write_3dm():
        return (
            "A .3dm file needs the Python module rhino3dm, which is not installed. Choose a name "
            "that ends in .step."
        )
    return ""


def write_jobs(path: str, jobs: Sequence[PatchJob], unit: str, scale: float) -> None:
    """The file, a part an object, whole or not at all; raises OSError. A file of Rhino if it ends in
    .3dm, else a STEP file. `scale`: units of the file in a Blender unit.
    """
    known = core.module()
    write = known.write_3dm if _is_rhino(path) else known.write_step
    write(
        path,
        [job.patches.transformed(job.placement) for job in jobs],
        unit=unit.lower(),
        scale=scale,
        names=[job.name for job in jobs],
        colours=[colours.of_patches(job.colours, job.patches) for job in jobs],
    )


def _is_rhino(path: str) -> bool:
    return path.lower().endswith(".3dm")


def summary(jobs: Sequence[PatchJob], unit: str, scale: float) -> str:
    """`96 patches, 0.008 mm off, 0.02° at edges`, of all jobs, the worst of them."""
    told, each = _TOLD.get(unit, ("mm", "MM"))
    return words.summary(
        sum(len(job.patches) for job in jobs),
        max(job.off for job in jobs) * scale * METRES[unit] / METRES[each],
        told,
        max(job.angle for job in jobs),
    )
