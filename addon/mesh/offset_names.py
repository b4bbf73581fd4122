# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices named by station and line, as a table of offsets has named them."""

from collections.abc import Sequence

import numpy as np

from ..blender import Mesh
from .layers import OFFSET_NAMES, fill_layer, find_layer, layer_values, make_layer


def write_names(mesh: Mesh, names: Sequence[str]) -> None:
    """(n,) `station 4, WL 300`; empty where a vertex has none."""
    stored = np.array([name.encode() for name in names], object)  # Blender has bytes there
    fill_layer(make_layer(mesh, OFFSET_NAMES, "STRING", "POINT"), stored)


def read_names(mesh: Mesh) -> list[str]:
    """(n,), or none where the mesh is of no table. Not in Edit Mode."""
    layer = find_layer(mesh, OFFSET_NAMES, "STRING", "POINT")
    if layer is None:
        return []
    return [name.decode("utf-8", "replace") for name in layer_values(layer).tolist()]


def stations(names: Sequence[str], x: np.ndarray) -> list[tuple[str, float]]:
    """Of vertices (n,) with these `names` and `x`: each station's name and mean place, in order."""
    places: dict[str, list[float]] = {}
    for name, place in zip(names, x.tolist()):
        if name:
            places.setdefault(name.split(", ")[0], []).append(place)
    found = [(name, sum(there) / len(there)) for name, there in places.items()]
    return sorted(found, key=lambda station: station[1])
