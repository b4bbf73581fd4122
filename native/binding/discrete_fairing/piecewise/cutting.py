# SPDX-License-Identifier: GPL-3.0-or-later
"""pieces(): a control mesh, cut into pieces that are faired alone, with the settings of each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..arrays import face_arrays, marked, ranges, shape_array, vertex_array
from ..automatic import resolved
from ..converters import whole
from ..errors import fairing_error
from ..mesh_part import MeshPart
from ..options import FACE_IDS, ONE_A_VERTEX, SETTINGS, Settings, native_options
from .outline import Outline
from .piece import Piece

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
BY_ID = (*FACE_IDS, "corner_vertices", "edge_sharpness")


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
        for name in FACE_IDS:
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


def pieces(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    levels: int = 3,
    energy: str = "thin_plate",
    *,
    count: int,
    rings: int = 8,
    shapes: ArrayLike | Sequence[ArrayLike] | None = None,
    symmetry_plane: str | None = None,
    **settings: Unpack[Settings],
) -> list[Piece]:
    """Cut a control mesh into pieces whose surfaces together form that of the whole mesh.

    Each piece knows its own faces and some rings around them, and can be pickled and faired anywhere. What
    concerns the whole is decided here, once: what is mended, which way faces run, what is a crease, and
    where all curves lie. The whole's surface is never computed.

    Parameters
    ----------
    vertices, faces, levels, energy, shapes
        As fair() takes them.
    count : int
        How many pieces; there are fewer where the mesh has fewer faces.
    rings : int
        Of control faces around each piece that are faired with it. With every ring the difference
        to the whole's surface becomes about 2.6 times smaller.
    **settings
        Those of fair(), but for symmetry_plane and measure, which exclude pieces, and for threads and
        memory_limit, which Piece.fair() takes.

    Returns
    -------
    list of Piece
        The same on every call. join() takes their parts in any order.

    Raises
    ------
    FairingError
        As fair() does, for the whole; BAD_OPTION for settings that exclude pieces.
    """
    wanted, around = whole("count", count), whole("rings", rings)
    if wanted < 1:
        raise fairing_error("BAD_OPTION", f"count is {wanted}; it must be 1 or more.")
    points = vertex_array(vertices)
    others = shape_array(shapes, len(points))
    flat = face_arrays(faces)
    asked = {**settings, "energy": energy, "symmetry_plane": symmetry_plane}
    given, options = checked(resolved(asked, points, *flat), levels)
    outline = Outline(points, *flat, others, options)
    control = outline.control
    weights = np.bincount(control.polygon, control.quad + 1.0, outline.polygon_count)
    labels = _labels(outline.middles(), weights, min(wanted, outline.polygon_count))
    return Cutter(outline, labels, around, PieceSettings(given, outline)).all()


class Cutter:
    """Cuts one mesh into pieces; `labels` has the piece of each face."""

    def __init__(self, outline: Outline, labels: np.ndarray, rings: int, settings: PieceSettings):
        self.outline, self.labels, self.rings, self.settings = outline, labels, rings, settings
        self.count = int(labels.max()) + 1
        self.vertex_owner = outline.vertex_owner(labels)
        self.edge_owner = outline.edge_owner(labels)
        self.mesh = MeshPart.of(outline.vertices, outline.corners, outline.offsets)
        control = outline.control
        self.control_at = np.searchsorted(control.polygon, np.arange(outline.polygon_count + 1))
        self.curve_of = np.full(len(outline.edge), -1, np.int64)
        self.curve_of[outline.curve] = np.arange(len(outline.curve))
        self.softness = outline.on_edges(*outline.options.soft_creases)
        face, side = np.nonzero(control.edge >= 0)
        edge = control.edge[face, side]
        several = outline.edge_uses[edge] > 2
        self.sheet_edge, self.sheet_polygon = edge[several], control.polygon[face[several]]
        self.local = np.full(outline.input_vertices, -1, np.int64)  # scratch
        self.reached = np.zeros(outline.polygon_count, bool)  # scratch

    def all(self) -> list[Piece]:
        return [self.piece(index) for index in range(self.count)]

    def with_rings(self, polygons: np.ndarray) -> np.ndarray:
        """These faces and the rings of faces around them, ascending."""
        found, front = [polygons], polygons
        self.reached[polygons] = True
        for _ in range(self.rings):
            near = self.mesh.faces_at(np.unique(self.mesh.corners_at(front)))
            front = near[~self.reached[near]]
            if not len(front):
                break
            self.reached[front] = True
            found.append(front)
        every = self.with_sheets(np.sort(np.concatenate(found)))
        self.reached[every] = False
        return every

    def with_sheets(self, polygons: np.ndarray) -> np.ndarray:
        """These faces and all others at edges of several sheets, two of which would be taken for one sheet."""
        while True:
            edges = self.sheet_edge[np.isin(self.sheet_polygon, polygons)]
            beside = self.sheet_polygon[np.isin(self.sheet_edge, edges)]
            every = np.union1d(polygons, beside)
            if len(every) == len(polygons):
                return polygons
            polygons = every

    def piece(self, index: int) -> Piece:
        outline = self.outline
        polygon = self.with_rings(np.flatnonzero(self.labels == index))
        part = self.mesh.part(polygon)
        vertex_id = part.vertex_ids
        self.local[vertex_id] = np.arange(len(vertex_id))
        rows = ranges(self.control_at[polygon], self.control_at[polygon + 1])
        control = outline.control.take(rows)
        mine = self.labels[control.polygon] == index
        of_edges, curves = self.edges_of(control.edge)
        return Piece(
            index=index,
            vertices=part.points,
            shapes=np.ascontiguousarray(outline.shapes[:, vertex_id]),
            corners=part.corners,
            offsets=part.offsets,
            settings=self.settings.of(vertex_id, polygon) | of_edges,
            of_whole={"units": list(outline.units), **curves},
            vertex_id=vertex_id,
            control=control,
            owned=mine,
            corner_owned=self.vertex_owner[control.vertex] == index,
            side_owned=self.edge_owner[control.edge] == index,
            surface=self.surface(index),
        )

    def edges_of(self, side_edge: np.ndarray) -> tuple[dict[str, Any], dict[str, Any]]:
        """Settings of a piece: creases, boundaries and cut edges; and the curves of the whole on them."""
        outline = self.outline
        edges, uses = np.unique(side_edge[side_edge >= 0], return_counts=True)
        kinds = _native.curve_edge, _native.boundary_edge, _native.straight_edge
        is_curve, is_boundary, is_straight = (outline.is_(kind)[edges] for kind in kinds)
        # Where it was cut off a piece ends along straight edges. Measured (docs/developers/notes/pieces.md): the
        # difference to the whole is that with curves there, and with free edges, within a third; but free
        # edges take two to four times as long, and total curvature goes astray along them.
        is_cut = (uses == 1) & (outline.edge_uses[edges] > 1)
        handed = edges[self.curve_of[edges] >= 0]
        points = outline.curve_points[:, self.curve_of[handed]]
        soft = edges[self.softness[edges] > 0]
        straight = (is_boundary & is_straight) | is_cut
        settings = {
            "crease_edges": self.pairs(edges[is_curve & ~is_boundary]),
            "soft_creases": (self.pairs(soft), self.softness[soft]),
            "boundary_edges": {
                "free": self.pairs(edges[is_boundary & ~is_curve]),
                "linear": self.pairs(edges[straight]),
            },
        }
        return settings, {"edges": self.pairs(handed), "points": points.reshape(-1, 3)}

    def pairs(self, edges: np.ndarray) -> np.ndarray:
        """(k, 2): the piece's own ids of edges' ends."""
        return self.local[self.outline.edge[edges]].reshape(-1, 2)

    def surface(self, index: int) -> dict[str, Any]:
        """The data that all parts of a surface share; the first part has the points of no piece."""
        outline = self.outline
        same: dict[str, Any] = {
            "fingerprint": outline.fingerprint,
            "count": self.count,
            "rings": self.rings,
            "input_vertices": outline.input_vertices,
            "numbering": outline.numbering,
            "shapes": len(outline.shapes),
            "size": float(np.ptp(outline.vertices[outline.corners], axis=0).max()),
        }
        if index == 0:
            alone = np.flatnonzero(self.vertex_owner < 0)
            same |= {
                "report": outline.report,
                "crease_edges": outline.crease_edges(),
                "alone": alone,
                "alone_points": outline.vertices[alone],
                "alone_shapes": outline.shapes[:, alone],
            }
            if outline.mended:
                same["mended"] = outline.mended
        return same


def _labels(centres: np.ndarray, weights: np.ndarray, count: int) -> np.ndarray:
    """(m,) int32: the piece of each face, from 0 to count - 1, numbered by their first faces. The mesh is cut
    across its longest side, and the parts again, so that all have about the same weight.

    centres: (m, 3), of the faces; weights: (m,), the number of refined faces of each; count: at most m.
    """
    labels = np.zeros(len(centres), np.int64)
    parts = [(np.arange(len(centres)), count)]
    found = 0
    while parts:
        faces, pieces = parts.pop()
        if pieces == 1:
            labels[faces] = found
            found += 1
            continue
        axis = int(np.argmax(np.ptp(centres[faces], axis=0)))
        faces = faces[np.argsort(centres[faces, axis], kind="stable")]
        before = np.cumsum(weights[faces])
        here = pieces // 2
        share = np.searchsorted(before, before[-1] * here / pieces)
        cut = int(np.clip(share, here, len(faces) - (pieces - here)))
        parts += [(faces[cut:], pieces - here), (faces[:cut], here)]
    _, first, place = np.unique(labels, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int32)
    rank[np.argsort(first)] = np.arange(len(first))
    return rank[place]
