# SPDX-License-Identifier: GPL-3.0-or-later
"""A table of vertices, their strain and their moves, for a yard or a spreadsheet. No Blender."""

import csv
from collections.abc import Iterable, Sequence
from io import StringIO

import numpy as np

_DIGITS = 9  # significant digits: a hundredth of a millimetre on a kilometre


def text(
    positions: np.ndarray,
    lengths: np.ndarray,
    eased: np.ndarray | None = None,
    names: Sequence[str] = (),
) -> str:
    """The table with its header, as comma-separated values. `positions` (n, 3) and strain `lengths` (n,),
    NaN if there is none; `eased` (n, 3): positions after easing, None without it. `names` (n,) of a
    table of offsets become the columns station and line.
    """
    head = ["vertex", *(["station", "line"] if names else []), "x", "y", "z"]
    columns: list[Iterable[float]] = [*positions.T]
    if eased is not None:
        head += ["x_eased", "y_eased", "z_eased", "move"]
        columns += [*eased.T, np.linalg.norm(eased - positions, axis=1)]
    head.append("strain")
    columns.append(lengths)
    written = StringIO()
    rows = csv.writer(written)
    rows.writerow(head)
    for index, numbers in enumerate(zip(*columns, strict=True)):
        name = _parts(names[index]) if names else ()
        rows.writerow([index, *name, *map(_number, numbers)])
    return written.getvalue()


def _parts(name: str) -> list[str]:
    """`4` and `WL 300` of `station 4, WL 300`."""
    station, _, line = name.partition(", ")
    return [station.removeprefix("station "), line]


def _number(value: float) -> str:
    """Empty for NaN."""
    return "" if np.isnan(value) else f"{value:.{_DIGITS}g}"
