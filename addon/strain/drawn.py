# SPDX-License-Identifier: GPL-3.0-or-later
"""Dots, needles and labels as arrays for the graphics card. No Blender."""

from collections.abc import Callable

import numpy as np

from ..inspection.colours import shades_of
from .strained import Strained

# the largest magnification of needles; shorter ones are rounding
_MOST = 1000.0
_VIVID = 1.5  # brightness, since the ends of the scale are too dark for lines on a grey surface
_CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, -1), (1, 1), (-1, 1)], np.float32)


def magnification(strained: Strained, length: float = 1.0) -> float:
    """1, 2, 5, 10 … 1000, such that the longest needle is at most `length` mean edges."""
    longest = strained.largest
    if longest <= 0.0:
        return 1.0
    room = max(1.0, min(_MOST, length * strained.edge_length / longest))
    decade = 10.0 ** np.floor(np.log10(room))
    step = next(step for step in (5.0, 2.0, 1.0) if step * decade <= room * (1.0 + 1e-9))
    return float(step * decade)


def colours(strained: Strained, ids: np.ndarray) -> np.ndarray:
    """(k, 4) float32 sRGBA: red if the surface would move outwards at the vertex, blue if inwards."""
    limit = _VIVID * strained.largest or 1.0
    return shades_of(strained.lengths[ids], (-limit, limit), signed=True)


def tips(strained: Strained, ids: np.ndarray, times: float) -> np.ndarray:
    """(k, 3) float32: ends of the needles of the vertices `ids`, magnified by `times`."""
    return (strained.positions[ids] + times * strained.directions[ids]).astype(np.float32)


def needles(strained: Strained, times: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (2 h, 3) float32 of needles from held to released places, and colours (2 h, 4)."""
    ids = strained.held
    begin = strained.positions[ids].astype(np.float32)
    points = np.stack([begin, tips(strained, ids, times)], axis=1).reshape(-1, 3)
    return points, np.repeat(colours(strained, ids), 2, axis=0)


def dots(strained: Strained) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Two triangles for each held vertex, with all six corners at its position: positions (6 h, 3)
    float32, offsets (6 h, 2) in radii of the dot, colours (6 h, 4). The most strained ones come last,
    on top.
    """
    ids = strained.worst(len(strained.held))[::-1]
    places = np.repeat(strained.positions[ids].astype(np.float32), 6, axis=0)
    return places, np.tile(_CORNERS, (len(ids), 1)), np.repeat(colours(strained, ids), 6, axis=0)


def labels(
    strained: Strained, count: int, times: float, text: Callable[[float], str]
) -> list[tuple[np.ndarray, str, bool]]:
    """For each of the `count` worst vertices: the position (3,) of its label, the text, such as `31:
    4.2 mm` or its name in a table of offsets, and whether the vertex is an outlier; `text` formats a
    length.
    """
    ids, wrong = strained.worst(count), set(strained.wrong.tolist())
    places = tips(strained, ids, times)
    return [
        (
            place,
            f"{strained.names[index] if strained.names else index}: {text(abs(float(strained.lengths[index])))}",
            index in wrong,
        )
        for place, index in zip(places, ids.tolist(), strict=True)
    ]
