# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes polylines and texts as a DXF file of release 12, which all drawing programs read. No Blender."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Polyline:
    layer: str
    points: np.ndarray  # (k, 3)
    closed: bool = False  # a closed one does not repeat its first point


@dataclass(frozen=True)
class Label:
    layer: str
    place: tuple[float, float]
    height: float
    text: str


def text(drawing: Iterable[Polyline | Label]) -> str:
    """The text of the file; ASCII, each layer with its own colour."""
    drawing = list(drawing)
    layers = sorted({item.layer for item in drawing})
    ends = np.concatenate([_extent(item) for item in drawing] or [np.zeros((1, 3))])
    groups: list[tuple[int, Any]] = [(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1009")]
    for name, corner in (("$EXTMIN", ends.min(axis=0)), ("$EXTMAX", ends.max(axis=0))):
        groups += [(9, name), *_at(corner)]
    groups += [(0, "ENDSEC"), (0, "SECTION"), (2, "TABLES"), (0, "TABLE"), (2, "LAYER")]
    groups.append((70, len(layers)))
    for colour, layer in enumerate(layers, 1):
        groups += [(0, "LAYER"), (2, layer), (70, 0), (62, colour), (6, "CONTINUOUS")]
    groups += [(0, "ENDTAB"), (0, "ENDSEC"), (0, "SECTION"), (2, "ENTITIES")]
    for item in drawing:
        groups += _polyline(item) if isinstance(item, Polyline) else _label(item)
    groups += [(0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code:3d}\r\n{value}\r\n" for code, value in groups)


def _polyline(line: Polyline) -> list[tuple[int, Any]]:
    groups = [(0, "POLYLINE"), (8, line.layer), (66, 1), *_at(np.zeros(3))]
    groups.append((70, 8 + line.closed))  # 8: in space
    for point in line.points:
        groups += [(0, "VERTEX"), (8, line.layer), *_at(point), (70, 32)]
    return [*groups, (0, "SEQEND"), (8, line.layer)]


def _label(label: Label) -> list[tuple[int, Any]]:
    said = label.text.encode("ascii", "replace").decode("ascii")
    place = _at(np.array([*label.place, 0.0]))
    return [(0, "TEXT"), (8, label.layer), *place, (40, _number(label.height)), (1, said)]


def _at(point: np.ndarray) -> list[tuple[int, Any]]:
    return [(code, _number(value)) for code, value in zip((10, 20, 30), point)]


def _number(value: float) -> str:
    return f"{float(value) + 0.0:.9g}"


def _extent(item: Polyline | Label) -> np.ndarray:
    return item.points if isinstance(item, Polyline) else np.array([[*item.place, 0.0]])
