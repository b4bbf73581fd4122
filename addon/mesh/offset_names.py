# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of vertices by station and line, from a table of offsets."""

from collections.abc import Sequence

import numpy as np

from ..blender import Mesh
from .layers import OFFSET_NAMES, fill_layer, make_layer, values_of_layer


def write_names(mesh: Mesh, names: Sequence[str]) -> None:
    """(n,) names such as `station 4, WL 300`; empty for vertices without one."""
    stored = np.array([name.encode() for name in names], object)  # Blender stores bytes here
    fill_layer(make_layer(mesh, OFFSET_NAMES, "STRING", "POINT"), stored)


def read_names(mesh: Mesh) -> list[str]:
    """(n,), or empty for meshes without a table. Not in Edit Mode."""
    names = values_of_layer(mesh, OFFSET_NAMES, "STRING", "POINT")
    return [] if names is None else [name.decode("utf-8", "replace") for name in names.tolist()]


def stations(names: Sequence[str], x: np.ndarray) -> list[tuple[str, float]]:
    """Each station's name and mean place, in order, from the `names` (n,) and `x` (n,) of vertices."""
    places: dict[str, list[float]] = {}
    for name, place in zip(names, x.tolist()):
        if name:
            places.setdefault(name.split(", ")[0], []).append(place)
    found = [(name, sum(there) / len(there)) for name, there in places.items()]
    return sorted(found, key=lambda station: station[1])
