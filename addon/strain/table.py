# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices, their strain and their moves as a table for a yard or a spreadsheet. No Blender."""

from collections.abc import Iterable

import numpy as np

Table = list[list[str]]  # rows of fields

_DIGITS = 9  # significant ones: a hundredth of a millimetre on a kilometre


def rows(positions: np.ndarray, lengths: np.ndarray, eased: np.ndarray | None = None) -> Table:
    """The table, its head first. `positions` (n, 3) and strain `lengths` (n,), NaN where there is
    none; `eased` (n, 3): where the vertices have been moved to, None: nowhere.
    """
    head = ["vertex", "x", "y", "z"]
    columns: list[Iterable[float]] = [*positions.T]
    if eased is not None:
        head += ["x_eased", "y_eased", "z_eased", "move"]
        columns += [*eased.T, np.linalg.norm(eased - positions, axis=1)]
    head.append("strain")
    columns.append(lengths)
    table = [
        [str(index), *map(_number, numbers)]
        for index, numbers in enumerate(zip(*columns, strict=True))
    ]
    return [head, *table]


def text(table: Table) -> str:
    """As comma-separated values; no field needs quotes."""
    return "".join(",".join(row) + "\r\n" for row in table)


def _number(value: float) -> str:
    """Empty for NaN."""
    return "" if np.isnan(value) else f"{value:.{_DIGITS}g}"
