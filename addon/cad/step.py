# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes finished jobs to one CAD file, and summarizes them."""

from collections.abc import Sequence

from .. import core
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
    """words.summary() of the worst values of all jobs, and the level that shows a finer surface."""
    symbol, each = _SYMBOLS.get(unit, ("mm", "MM"))
    factor = scale * METRES[unit] / METRES[each]
    apart = [job.apart for job in jobs if job.apart is not None]
    farthest = max(jobs, key=lambda job: job.apart or 0.0)
    return (
        words.summary(
            sum(len(job.patches.written) for job in jobs),
            max(job.from_surface for job in jobs) * factor,
            max(job.known_to for job in jobs) * factor,
            symbol,
            max(job.angle for job in jobs),
            max(apart) * factor if apart else None,
        )
        + _finer_text(farthest)
        + _scan_text(jobs, factor, symbol)
    )


def _scan_text(jobs: Sequence[PatchJob], factor: float, symbol: str) -> str:
    """The distances of the patches from their scans, and the allowed distance from their surfaces."""
    jobs = [job for job in jobs if job.patches.scan_distances is not None]
    if not jobs:
        return ""
    lengths = zip(*((*job.from_scan, job.allowed) for job in jobs))
    within, largest, off = (f"{words.short(max(each) * factor)} {symbol}" for each in lengths)
    allowed = words.allowed(off, max(job.patches.normal_tolerance for job in jobs))
    return f", within {within} of 95 % of the scan, {largest} at most: {allowed}"


def _finer_text(job: PatchJob) -> str:
    """The setting that shows the fitted surface, if the mesh shown is coarser."""
    has, needs = job.levels_shown, job.patches.levels
    if has is None or has >= needs or (job.apart or 0.0) <= job.off:
        return ""
    return f", as {job.name} has {has} levels: {needs} show what CAD gets"
