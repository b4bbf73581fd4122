# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the settings of a whole mesh and converts them to those of its pieces."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _native
from ..arrays import marked
from ..converters import whole
from ..errors import fairing_error
from ..options import ONE_A_VERTEX, SETTINGS, native_options
from .outline import Outline

# Arguments of fair() that pieces exclude, and the alternative.
EXCLUDED = {
    "symmetry_plane": "Mirror the mesh first, or fair the half as it is.",
    "measure": "No piece has an energy of its own. Measure the surface when it is whole.",
}
OF_RUN = ("threads", "memory_limit", "progress", "monitor")  # arguments of Piece.fair()
# Decided for the whole mesh and passed to pieces as elements.
DECIDED = (
    "crease_edges",
    "soft_creases",
    "crease_angle",
    "corner_angle",
    "boundary",
    "boundary_edges",
    "repair",
    "weld",
)
PER_VERTEX = ("tolerance", "normals", *ONE_A_VERTEX)
BY_ID = ("region", "flat_faces", "corner_vertices", "edge_sharpness")


def checked(given: dict[str, Any], levels: int) -> tuple[dict[str, Any], _native.Options]:
    """All settings of the whole: the caller's, and the core's.

    Raises FairingError BAD_OPTION for settings that exclude pieces, TypeError for unknown names.
    """
    settings = {name: value for name, value in given.items() if value is not None}
    for name in [name for name in settings if name in EXCLUDED]:
        if name == "measure" and not settings[name]:
            del settings[name]
            continue
        raise fairing_error("BAD_OPTION", f"{name} excludes pieces. {EXCLUDED[name]}")
    for name in OF_RUN:
        if name in given:
            raise fairing_error(
                "BAD_OPTION",
                f"{name} is not a setting of pieces(); give it to fair() of each piece.",
            )
    settings["levels"] = whole("levels", levels)
    return settings, native_options(settings)


class PieceSettings:
    """Makes the settings of pieces from those of the whole, which are prepared once."""

    def __init__(self, settings: dict[str, Any], outline: Outline):
        self.common = {
            name: value.item() if isinstance(value, np.generic) else value
            for name, value in settings.items()
            if name in SETTINGS and name not in (*DECIDED, *PER_VERTEX, *BY_ID)
        }
        # One-sided sheets become pieces with two sides, whose faces may still disagree in orientation.
        self.common["repair"] = "mend" if outline.report["sheets"]["one_sided"] else "refuse"
        options, count = outline.options, outline.input_vertices
        self.per_vertex: dict[str, np.ndarray] = {}
        tolerance = np.asarray(options.tolerance, float)
        if len(tolerance) == 1:
            self.common["tolerance"] = float(tolerance[0])
        else:
            self.per_vertex["tolerance"] = tolerance
        for name in ONE_A_VERTEX:
            if len(values := getattr(options, name)):
                self.per_vertex[name] = np.asarray(values, float)
        if len(options.normals):
            self.per_vertex["normals"] = np.asarray(options.normals, float).reshape(-1, 3)
        edges, sharpness = options.edge_sharpness
        self.sharp_edges = np.asarray(edges, np.int64).reshape(-1, 2)
        self.sharpness = np.asarray(sharpness, float)
        self.local = np.full(count, -1, np.int64)  # scratch
        self.corner = marked(np.asarray(options.corner_vertices, np.int64), count)
        self.of_faces: dict[str, np.ndarray] = {}
        for name in ("region", "flat_faces"):
            if settings.get(name) is not None:
                ids = np.asarray(getattr(options, name), np.int64)
                self.of_faces[name] = marked(ids, outline.polygon_count)

    def of(self, vertex_id: np.ndarray, polygon: np.ndarray) -> dict[str, Any]:
        """Settings of the piece with these vertices and faces of the whole, without those of edges."""
        settings = dict(self.common)
        for name, values in self.per_vertex.items():
            settings[name] = values[vertex_id]
        settings["corner_vertices"] = np.flatnonzero(self.corner[vertex_id])
        for name, chosen in self.of_faces.items():
            settings[name] = np.flatnonzero(chosen[polygon])
        if len(self.sharp_edges):
            settings["edge_sharpness"] = self._sharpness_in(vertex_id)
        return settings

    def _sharpness_in(self, vertex_id: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Sharpness of the edges with both ends in the piece; some may not be edges of its faces."""
        self.local[vertex_id] = np.arange(len(vertex_id))
        ends = self.local[self.sharp_edges]
        self.local[vertex_id] = -1
        inside = (ends >= 0).all(axis=1)
        return ends[inside], self.sharpness[inside]
