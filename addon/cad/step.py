# SPDX-License-Identifier: GPL-3.0-or-later
"""Finished jobs as one file for CAD, and what is said about it."""

from collections.abc import Sequence

from .. import core
from . import colours, words
from .fit import PatchJob
from .settings import METRES

# errors are told in millimetres where the file is metric
_SYMBOLS = {"IN": ("in", "IN"), "FT": ("in", "IN")}


def write_jobs(path: str, jobs: Sequence[PatchJob], unit: str, scale: float) -> None:
    """The file, a part an object, whole or not at all; raises OSError. `scale`: units of the file in a Blender unit."""
    core.module().write_step(
        path,
        [job.patches.transformed(job.placement) for job in jobs],
        unit=unit.lower(),
        scale=scale,
        names=[job.name for job in jobs],
        colours=[colours.of_patches(job.colours, job.patches) for job in jobs],
    )


def summary(jobs: Sequence[PatchJob], unit: str, scale: float) -> str:
    """`96 patches, 0.008 mm off, 0.02° at edges, 0.2 mm from the mesh shown`, of all jobs, the worst of
    them; the last where a surface is fitted, and at which levels the mesh would show it, where it has fewer.
    """
    symbol, each = _SYMBOLS.get(unit, ("mm", "MM"))
    factor = scale * METRES[unit] / METRES[each]
    apart = [job.apart for job in jobs if job.apart is not None]
    farthest = max(jobs, key=lambda job: job.apart or 0.0)
    return (
        words.summary(
            sum(len(job.patches) for job in jobs),
            max(job.off for job in jobs) * factor,
            symbol,
            max(job.angle for job in jobs),
            max(apart) * factor if apart else None,
        )
        + _finer_text(farthest)
        + _scan_text(jobs, factor, symbol)
    )


def _scan_text(jobs: Sequence[PatchJob], factor: float, symbol: str) -> str:
    """How far the patches are from the scans that they are near."""
    near = [job.from_scan for job in jobs if job.patches.scan_distances is not None]
    if not near:
        return ""
    within, largest = (words.short(max(each) * factor) for each in zip(*near))
    return f", within {within} {symbol} of 95 % of the scan, {largest} {symbol} at most"


def _finer_text(job: PatchJob) -> str:
    """Where the mesh shown is coarser than the surface that patches were fitted to, what shows that one."""
    has, needs = job.levels_shown, job.patches.levels
    if has is None or has >= needs or (job.apart or 0.0) <= job.off:
        return ""
    return f", as {job.name} has {has} levels: {needs} show what CAD gets"
