# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes finished jobs to one CAD file, and summarizes them."""

from collections.abc import Iterable, Sequence
from math import degrees

from .. import core
from ..words import counted
from . import colours, words
from .fit import PatchJob
from .settings import METRES

# errors are stated in millimetres if the file is metric
_SYMBOLS = {"IN": ("in", "IN"), "FT": ("in", "IN")}


def write_jobs(path: str, jobs: Sequence[PatchJob], unit: str, scale: float) -> None:
    """Writes a complete file, one part an object, or none: OSError. `scale`: units in Blender's."""
    core.module().write_step(
        path,
        [job.patches.transformed(job.placement) for job in jobs],
        unit=unit.lower(),
        scale=scale,
        names=[job.name for job in jobs],
        colours=[colours.of_patches(job.colours, job.patches) for job in jobs],
    )


def summary(jobs: Sequence[PatchJob], unit: str, scale: float) -> str:
    """The worst values of all jobs, for example `96 patches, 0.003 mm off a surface known to 0.005 mm, 0.02° at edges,
    0.2 mm from the mesh shown`, and the level that shows a finer surface.
    """
    symbol, each = _SYMBOLS.get(unit, ("mm", "MM"))
    factor = scale * METRES[unit] / METRES[each]

    def worst(lengths: Iterable[float]) -> str:
        return f"{words.short(max(lengths) * factor)} {symbol}"

    count = counted(sum(len(job.patches.written) for job in jobs), "{patch|patches}")
    off = worst(job.length(job.patches.largest_residual) for job in jobs)
    known = worst(job.length(job.patches.refinement_error.max(initial=0)) for job in jobs)
    angle = words.short(degrees(max(job.angle for job in jobs)))
    text = f"{count}, {off} off a surface known to {known}, {angle}° at edges"
    if apart := [job.apart for job in jobs if job.apart is not None]:
        text += f", {worst(apart)} from the mesh shown"
    text += _finer_text(max(jobs, key=lambda job: job.apart or 0.0))
    scanned = [job for job in jobs if job.patches.scan_distances is not None]
    if scanned:
        lengths = zip(
            *((*map(job.length, job.patches.scan_within), job.allowed) for job in scanned)
        )
        within, largest, off = map(worst, lengths)
        angle = words.short(degrees(max(job.patches.normal_tolerance for job in scanned)))
        text += (
            f", within {within} of 95 % of the scan, {largest} at most: "
            f"patches were allowed to be {off} off and to meet at {angle}°"
        )
    return text


def _finer_text(job: PatchJob) -> str:
    """The setting that shows the fitted surface, if the mesh shown is coarser."""
    has, needs = job.levels_shown, job.patches.levels
    if has is None or has >= needs or (job.apart or 0.0) <= job.length(job.patches.largest_off):
        return ""
    return f", as {job.name} has {has} levels: {needs} show what CAD gets"
