# SPDX-License-Identifier: GPL-3.0-or-later
"""A table of vertices, their strain and their moves, for a yard or a spreadsheet. No Blender."""

from collections.abc import Iterable, Sequence

import numpy as np

Table = list[list[str]]  # rows of fields

_DIGITS = 9  # significant digits: a hundredth of a millimetre on a kilometre


def rows(
    positions: np.ndarray,
    lengths: np.ndarray,
    eased: np.ndarray | None = None,
    names: Sequence[str] = (),
) -> Table:
    """The table with its header. `positions` (n, 3) and strain `lengths` (n,), NaN if there is none;
    `eased` (n, 3): positions after easing, None without it. `names` (n,) of a table of offsets become
    the columns station and line.
    """
    head = ["vertex", *(["station", "line"] if names else []), "x", "y", "z"]
    columns: list[Iterable[float]] = [*positions.T]
    if eased is not None:
        head += ["x_eased", "y_eased", "z_eased", "move"]
        columns += [*eased.T, np.linalg.norm(eased - positions, axis=1)]
    head.append("strain")
    columns.append(lengths)
    table = [
        [str(index), *(_parts(names[index]) if names else ()), *map(_number, numbers)]
        for index, numbers in enumerate(zip(*columns, strict=True))
    ]
    return [head, *table]


def text(table: Table) -> str:
    """As comma-separated values."""
    return "".join(",".join(map(_field, row)) + "\r\n" for row in table)


def _parts(name: str) -> list[str]:
    """`4` and `WL 300` of `station 4, WL 300`."""
    station, _, line = name.partition(", ")
    return [station.removeprefix("station "), line]


def _field(text: str) -> str:
    """In quotes if needed."""
    quoted = text.replace('"', '""')
    return f'"{quoted}"' if any(sign in text for sign in ',"\r\n') else text


def _number(value: float) -> str:
    """Empty for NaN."""
    return "" if np.isnan(value) else f"{value:.{_DIGITS}g}"
