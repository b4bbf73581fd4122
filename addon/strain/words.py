# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences on strain and easing; and a table of vertices, their strain and their moves, for a yard or a spreadsheet. No
Blender.
"""

import csv
from collections.abc import Iterable, Sequence
from io import StringIO

import numpy as np

from ..units import Text
from ..words import counted, listed

_NAMED = 5  # vertices named in a sentence


def count(number: int) -> str:
    """For example `1 vertex`, `63 vertices`."""
    return counted(number, "{vertex|vertices}")


def name(index: int, names: Sequence[str]) -> str:
    """The name of a vertex: that of a table of offsets, else `vertex 31`."""
    return (names[index] if names else "") or f"vertex {index}"


def offs(
    ids: Sequence[int] | np.ndarray, lengths: np.ndarray, text: Text, names: Sequence[str] = ()
) -> str:
    """For example `31 by 4.2 mm and 4 more`, or by `names`: `station 4, WL 300: 4.2 mm`."""
    named = {i: text(abs(float(lengths[i]))) for i in list(ids)[:_NAMED]}
    more = [f"{len(ids) - _NAMED:,} more"] * (len(ids) > _NAMED)
    if names:
        return "; ".join([f"{name(i, names)}: {off}" for i, off in named.items()] + more)
    return listed([f"{i} by {off}" for i, off in named.items()] + more)


def found(chosen: np.ndarray, lengths: np.ndarray, text: Text, names: Sequence[str] = ()) -> str:
    """The result of selecting strained vertices; `lengths`: (n,), NaN if a vertex is not held."""
    held = int((~np.isnan(lengths)).sum())
    return f"{len(chosen):,} of {count(held)} selected: {offs(chosen, lengths, text, names)}"


def looks_like_knuckle(chain: Sequence[int], names: Sequence[str]) -> str:
    """A question to the user; `chain`: ids in a row."""
    ends = f"{name(chain[0], names)} to {name(chain[-1], names)}"
    return f"These look like a knuckle: {ends}. Crease them?"


def none_above(threshold: float, largest: float, text: Text) -> str:
    return (
        f"No vertex strains by more than {text(threshold)}; the largest strain is {text(largest)}"
    )


def moved(moves: np.ndarray, text: Text, names: Sequence[str] = ()) -> str:
    """For example `2 vertices moved: 31 by 4.2 mm and 7 by 3 mm`; `moves`: (n,) lengths."""
    order = np.argsort(-moves, kind="stable")
    order = order[moves[order] > 0]
    if not len(order):
        return "No vertex moved: the surface already passes through them"
    return f"{count(len(order))} moved: {offs(order, moves, text, names)}"


def eased(
    noise: float,
    moves: np.ndarray,
    strain: np.ndarray,
    wrong: np.ndarray,
    floor: float,
    text: Text,
    names: Sequence[str] = (),
) -> str:
    """The result of automatic easing. `noise`: the scatter, a length; `strain`: (n,) before; `wrong`:
    (k,) ids of outliers, the worst first; `floor`: the limit of scatter.
    """
    if not moves.any():
        return "No vertex moved: scatter cannot be distinguished from the shape"
    said = [f"The scatter is about {text(noise)}."]
    if len(wrong):
        held = count(int((~np.isnan(strain)).sum()))
        are = "is" if len(wrong) == 1 else "are"
        said.append(
            f"{len(wrong):,} of {held} {are} off by more: {offs(wrong, strain, text, names)}."
        )
    else:
        said.append(f"No vertex is off by more than scatter explains, {text(floor)}.")
    said.append(f"{_largest(moves, text, names)}.")
    return " ".join(said)


def moved_within(
    moves: np.ndarray, tolerance: float, strain: np.ndarray, text: Text, names: Sequence[str] = ()
) -> str:
    """The result of easing within a `tolerance`; `strain`: (n,) before."""
    if not moves.any():
        return (
            f"No vertex moved: none may move, or there is nothing to ease within {text(tolerance)}"
        )
    beyond = int((np.abs(strain[~np.isnan(strain)]) > tolerance).sum())
    said = f"{count(int((moves > 0).sum()))} moved by at most {text(tolerance)}. {_largest(moves, text, names)}."
    if not np.isclose(moves.max(), tolerance):
        said += " The scatter of the vertices explains no more: use Stiffness to move them farther."
    if beyond:
        said += f" {count(beyond)} strained by more than the tolerance before."
    return said


def _largest(moves: np.ndarray, text: Text, names: Sequence[str]) -> str:
    worst = int(np.argmax(moves))
    return f"The largest move is {text(float(moves[worst]))}, at {name(worst, names)}"


_DIGITS = 9  # significant digits: a hundredth of a millimetre on a kilometre


def table_text(
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
