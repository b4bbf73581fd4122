# SPDX-License-Identifier: GPL-3.0-or-later
"""Interpolates values from control faces to refined faces, in chunks, without large copies.

The control faces are found in the core's result, with the input's corners: an input polygon may be split into several; all
triangles of a fan have its centre last.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..core import ControlArrays, module


@dataclass(frozen=True)
class ControlFaces:
    """F control faces with k corners each."""

    vertices: np.ndarray  # (F, k) int32; ids from the vertex count on are centres of fans
    # (F, k) int32, corners of the input; ids from the corner count on are centres of fans
    corners: np.ndarray
    polygon: np.ndarray  # (F,) int32, the input face

    @property
    def size(self) -> int:
        """k"""
        return self.vertices.shape[1]


def find_control_faces(
    fine: np.ndarray, fine_polygon: np.ndarray, lattice: Any, arrays: ControlArrays
) -> ControlFaces:
    """ControlFaces of the refined faces `fine` (f, k); `fine_polygon` (f,): their input faces; the core's `lattice`."""
    own = lattice.first_corner[lattice.corners]
    vertices = fine.reshape(-1, lattice.cells.size)[:, own]
    polygon = fine_polygon[:: len(lattice.cells)]
    return ControlFaces(vertices, _corners(vertices, polygon, arrays), polygon)


def _corners(vertices: np.ndarray, polygon: np.ndarray, arrays: ControlArrays) -> np.ndarray:
    """(F, k) int32: the corner of `polygon` at each of the `vertices`."""
    size = vertices.shape[1]
    first = arrays.offsets[polygon]
    found = first[:, None] + np.arange(size, dtype=np.int32)
    whole = arrays.offsets[polygon + 1] - first == size
    whole[whole] = (arrays.corners[found[whole]] == vertices[whole]).all(axis=1)
    split = np.flatnonzero(~whole)  # or reversed
    if len(split):
        found[split] = _search(vertices[split], polygon[split], arrays)
    return found


def _search(vertices: np.ndarray, polygon: np.ndarray, arrays: ControlArrays) -> np.ndarray:
    # no polygon contains a vertex twice, so polygon and vertex determine a corner
    centre = vertices - len(arrays.positions)
    wanted = _keys(polygon[:, None], vertices)
    polygons = np.unique(polygon)
    sizes = arrays.offsets[polygons + 1] - arrays.offsets[polygons]
    within = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    candidates = np.repeat(arrays.offsets[polygons], sizes) + within
    keys = _keys(np.repeat(polygons, sizes), arrays.corners[candidates])
    order = np.argsort(keys)
    place = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
    return np.where(centre >= 0, len(arrays.corners) + centre, candidates[order[place]]).astype(
        np.int32
    )


def _keys(polygon: np.ndarray, vertex: np.ndarray) -> np.ndarray:
    return polygon.astype(np.int64) << 32 | vertex


class Centres:
    """The centres of all fans, each of control triangles one after another."""

    def __init__(self, triangles: ControlFaces, arrays: ControlArrays) -> None:
        """`triangles`: ControlFaces of size 3; `arrays`: the input mesh."""
        n, c = len(arrays.positions), len(arrays.corners)
        fan = triangles.vertices[:, 2] >= n
        self._vertices = triangles.vertices[fan, 0]
        self._corners = triangles.corners[fan, 0]
        centre = triangles.corners[fan, 2] - c
        self._starts = np.flatnonzero(np.diff(centre, prepend=-1))
        self.count = len(self._starts)
        self._sizes = np.diff(self._starts, append=len(centre))
        self._weights = self._area_weights(arrays.positions)

    def corner(self, values: np.ndarray) -> np.ndarray:
        """(c, w) values of input corners → (centres, w) float64."""
        return self._mean(values[self._corners])

    def point(self, values: np.ndarray) -> np.ndarray:
        """(n, w) values of control vertices → (centres, w) float64."""
        return self._mean(values[self._vertices])

    def _mean(self, values: np.ndarray) -> np.ndarray:
        if not self.count:
            return np.empty((0, values.shape[1]))
        return np.add.reduceat(values * self._weights[:, None], self._starts, axis=0)

    def _area_weights(self, positions: np.ndarray) -> np.ndarray:
        """(members,) float64: with these weights the mean of the corners is the area centroid, where
        the core places the centre.

        So a value that is linear in the plane of a polygon stays linear. A centroid outside the
        corners' hull, which strongly warped polygons may have, is replaced by the plain mean.
        """
        plain = 1.0 / np.repeat(self._sizes, self._sizes)
        if not self.count:
            return plain
        points = positions[self._vertices]
        mean = np.add.reduceat(points * plain[:, None], self._starts, axis=0)
        arm = points - np.repeat(mean, self._sizes, axis=0)
        after = self._starts + self._sizes - 1
        step = np.arange(1, len(arm) + 1)
        step[after] = self._starts
        normal = np.cross(arm, arm[step])
        whole = np.repeat(np.add.reduceat(normal, self._starts, axis=0), self._sizes, axis=0)
        part = np.einsum("ij,ij->i", normal, whole) / np.maximum(
            np.einsum("ij,ij->i", whole, whole), 1e-300
        )
        before = np.empty_like(part)
        before[step] = part
        weights = (plain + part + before) / 3
        usable = np.logical_and.reduceat(weights >= 0, self._starts)
        return np.where(np.repeat(usable, self._sizes), weights, plain)


CHUNK = 1 << 18  # values at a time, which fit in a processor's cache


@dataclass(frozen=True)
class Patch:
    """The refined faces `fine` (F n², k) of control `faces`; `start`: their first corner."""

    lattice: Any  # of the core, n times n cells
    faces: ControlFaces
    fine: np.ndarray
    start: int

    def mix_corners(self, known: np.ndarray, out: np.ndarray) -> None:
        """Writes interpolated `known` (corners and centres, w) to `out` (refined corners, w)."""
        own = self.own(out)
        for part, values in self._mixed(known, self.faces.corners):
            for w, lattice in enumerate(values):
                own[part, :, w] = np.take(lattice, self.lattice.cells.ravel(), axis=1)

    def mix_points(self, known: np.ndarray, out: np.ndarray) -> None:
        """The same at refined vertices: `known` (vertices and centres, w) → `out` (vertices, w)."""
        for part, values in self._mixed(known, self.faces.vertices):
            out[self.points(part)] = np.moveaxis(values, 0, 2)

    def points(self, part: slice = slice(None)) -> np.ndarray:
        """(F, P): the refined vertices of the control faces, or of a part of them."""
        return self.fine.reshape(len(self.faces.polygon), -1)[part][:, self.lattice.first_corner]

    def nearest(self, ids: np.ndarray, count: int) -> np.ndarray:
        """(F, P): for each point that of the `ids` (F, k) of the corners which is nearest, the first of
        several; `count`: of control vertices, since the centre of a fan has no value.
        """
        weights = self.lattice.weights
        plain, of_fan = ids[:, weights.argmax(axis=1)], ids[:, weights[:, :-1].argmax(axis=1)]
        return np.where(self.faces.vertices[:, -1:] >= count, of_fan, plain)

    def own(self, out: np.ndarray) -> np.ndarray:
        """The part of `out` (corners, …) that belongs to these faces, by control face."""
        own = out[self.start : self.start + self.fine.size]
        return own.reshape(len(self.faces.polygon), -1, *out.shape[1:])

    def _chunks(self, width: int) -> Iterator[slice]:
        faces = len(self.faces.polygon)
        step = max(1, CHUNK // (len(self.lattice.i) * width))
        return (slice(begin, min(begin + step, faces)) for begin in range(0, faces, step))

    def _mixed(self, known: np.ndarray, ids: np.ndarray) -> Iterator[tuple[slice, np.ndarray]]:
        """Chunks of faces, with their values (w, faces, P) float32 at all points."""
        width, size = known.shape[1], self.faces.size
        spread = np.ascontiguousarray(self.lattice.weights.T)
        for part in self._chunks(width):
            corners = np.moveaxis(known[ids[part]].astype(np.float64, copy=False), 2, 0)
            mixed = np.ascontiguousarray(corners).reshape(-1, size) @ spread
            yield part, mixed.astype(np.float32).reshape(width, -1, len(self.lattice.i))


class AttributeTransfer:
    """Transfers values from the n vertices, c corners, m faces and e edges of a control mesh to a
    refined one.

    The refined corners are those of the result's triangles, then of its quads, as in a mesh made of
    them.
    """

    def __init__(self, result: Any, arrays: ControlArrays, levels: int) -> None:
        """`result`: the core's, refined `levels` times; `arrays`: the control mesh."""
        self.levels = levels
        self.control_count = len(arrays.positions)
        self.vertex_count = len(result.vertices)
        self._faired = faired_mesh(result, arrays)
        own = self._faired.arrays
        self.patches: list[Patch] = []
        start = 0
        for fine, polygon in zip(result.faces, self._faired.polygons, strict=True):
            lattice = module().lattice.Lattice(2**levels, fine.shape[1] == 4)
            faces = find_control_faces(fine, polygon, lattice, own)
            if faces.size == 3:
                self._centres = Centres(faces, own)
            if len(fine):
                self.patches.append(Patch(lattice, faces, fine, start))
            start += fine.size
        self.corner_count = start
        self._polygon = np.concatenate([result.triangle_polygon, result.quad_polygon])

    @property
    def triangle_count(self) -> int:
        """Triangles of the refined mesh, two for each quad."""
        return sum(len(patch.fine) * (patch.fine.shape[1] - 2) for patch in self.patches)

    def corner(self, values: np.ndarray) -> np.ndarray:
        """(c,) or (c, w) on corners → (refined corners, w) float32, within each face only."""
        values = self._faired.corner(_table(values))
        known = np.concatenate([values, self._centres.corner(values)])
        out = np.empty((self.corner_count, values.shape[1]), np.float32)
        for patch in self.patches:
            patch.mix_corners(known, out)
        return out

    def point(self, values: np.ndarray) -> np.ndarray:
        """(n,) or (n, w) numbers on vertices → (refined vertices, w) float32, the n first."""
        values = _table(values)
        known = np.concatenate([values, self._centres.point(values)])
        out = np.zeros((self.vertex_count, values.shape[1]), np.float32)
        for patch in self.patches:
            patch.mix_points(known, out)
        out[: len(known)] = known
        return out

    def own_point(self, values: np.ndarray) -> np.ndarray:
        """(n, …) → (refined vertices, …): the values on control vertices, 0 or False on all others."""
        out = np.zeros((self.vertex_count, *values.shape[1:]), values.dtype)
        out[: len(values)] = values
        return out

    def face(self, values: np.ndarray) -> np.ndarray:
        """(m, …) of any type on faces → (refined faces, …)."""
        return values[self._polygon]

    def edge_origin(self, corner_edge: np.ndarray, edge_count: int) -> np.ndarray:
        """(refined edges,) int32: the control edge that contains each, -1 for edges inside faces.

        `corner_edge` (refined corners,): the edge that leaves each corner; `edge_count`: number of
        edges.
        """
        origin = np.full(edge_count, -1, np.int32)
        for patch in self.patches:
            _edge_origin(patch, self._faired.arrays.edges, corner_edge, origin)
        return origin

    def pick_corner(self, values: np.ndarray) -> np.ndarray:
        """(c, …) of any type on corners → (refined corners, …): the value of the nearest corner of the
        same control face.
        """
        values = self._faired.pick_corner(values)
        out = np.empty((self.corner_count, *values.shape[1:]), values.dtype)
        for patch in self.patches:
            nearest = patch.nearest(patch.faces.corners, self.control_count)
            patch.own(out)[:] = values[nearest[:, patch.lattice.cells.ravel()]]
        return out

    def pick_point(self, values: np.ndarray) -> np.ndarray:
        """(n, …) of any type on vertices → (refined vertices, …): the value of the nearest vertex of a
        control face there.
        """
        out = np.zeros((self.vertex_count, *values.shape[1:]), values.dtype)
        for patch in self.patches:
            out[patch.points()] = values[patch.nearest(patch.faces.vertices, self.control_count)]
        out[: len(values)] = values
        return out


def _table(values: np.ndarray) -> np.ndarray:
    values = np.asarray(values)
    return values.reshape(len(values), -1)


def _edge_origin(
    patch: Patch, control_edges: np.ndarray, corner_edge: np.ndarray, origin: np.ndarray
) -> None:
    """Writes to `origin` (refined edges,) the id of the control edge, for all pieces of control edges
    in `patch`.

    `control_edges` (e, 2): their vertices; `corner_edge` (refined corners,): the refined edge that
    leaves each corner.
    """
    vertices, size = patch.faces.vertices, patch.faces.size
    if not len(vertices) or not len(control_edges):
        return
    pair_keys, lattice = module().arrays.pair_keys, patch.lattice
    keys = pair_keys(control_edges)
    order = np.argsort(keys, kind="stable")  # mending may have merged two edges: the first counts
    leaving = corner_edge[patch.start : patch.start + patch.fine.size].reshape(len(vertices), -1)
    for run, start, end in lattice.cell_sides:
        wanted = pair_keys(vertices[:, [start, end]])
        place = np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)
        edge = order[place]
        is_edge = keys[edge] == wanted  # a cut through a polygon is no control edge
        origin[leaving[is_edge][:, run * size + start]] = edge[is_edge, None]


def coarse_triangles(transfer: AttributeTransfer, levels: int) -> tuple[np.ndarray, np.ndarray]:
    """(t, 3) refined vertices on the lattice of `levels`, and (t,) the control face of each."""
    triangles, owners = [np.empty((0, 3), np.int32)], [np.empty(0, np.int64)]
    start = 0
    for patch in transfer.patches:
        faces = _coarse_faces(patch, levels)
        each = faces.shape[1]
        halves = [[0, 1, 2]] if faces.shape[2] == 3 else [[0, 1, 2], [0, 2, 3]]
        owner = np.repeat(start + np.arange(len(faces)), each)
        for half in halves:
            triangles.append(faces[:, :, half].reshape(-1, 3))
            owners.append(owner)
        start += len(faces)
    return np.concatenate(triangles), np.concatenate(owners)


def _coarse_faces(patch: Patch, levels: int) -> np.ndarray:
    """(F, 4^levels, k) refined vertices."""
    size = patch.faces.size
    lattice, coarse = patch.lattice, module().lattice.Lattice(2**levels, size == 4)
    step = lattice.n >> levels
    corner = lattice.first_corner[lattice.at(coarse.i * step, coarse.j * step)][coarse.cells]
    fine = patch.fine.reshape(len(patch.faces.polygon), -1)
    return fine[:, corner]


@dataclass(frozen=True)
class FairedMesh:
    """Its own `arrays`, with the vertices and edges of the control mesh under their ids."""

    arrays: ControlArrays
    # the faces in `arrays` of refined triangles and of refined quads
    polygons: tuple[np.ndarray, np.ndarray]
    # (c, 2) corners of the control mesh from which each corner is interpolated
    origin: np.ndarray | None
    share: np.ndarray | None  # (c,) float64, share of the second one

    def corner(self, values: np.ndarray) -> np.ndarray:
        """(control corners, w) numbers → (c, w), interpolated."""
        if self.origin is None or self.share is None:
            return values
        share = self.share[:, None]
        return (1.0 - share) * values[self.origin[:, 0]] + share * values[self.origin[:, 1]]

    def pick_corner(self, values: np.ndarray) -> np.ndarray:
        """(control corners, …) of any type → (c, …), from the nearer one."""
        if self.origin is None or self.share is None:
            return values
        return values[np.where(self.share > 0.5, self.origin[:, 1], self.origin[:, 0])]


def faired_mesh(result: Any, arrays: ControlArrays) -> FairedMesh:
    """`result`: the core's; `arrays`: the control mesh."""
    mended = result.mended
    if mended is None:
        return FairedMesh(arrays, (result.triangle_polygon, result.quad_polygon), None, None)
    own = replace(
        arrays,
        edges=mended.vertex_origin[arrays.edges],
        corners=mended.corners.astype(np.int32),
        corner_edges=arrays.corner_edges[mended.corner_origin[:, 0]],
        offsets=mended.offsets.astype(np.int32),
    )
    polygons = (mended.triangle_face, mended.quad_face)
    return FairedMesh(own, polygons, mended.corner_origin, mended.corner_share)
