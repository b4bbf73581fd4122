# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh at its border: tangent planes and curvatures there, and how two meshes join."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .arrays import face_arrays, following, ranges, vertex_array
from .errors import fairing_error

# (vertices, faces)
Mesh = tuple[ArrayLike, Any]

# The polynomial at a border vertex: rings of faces that it is fitted to, and its degree. On two halves of
# an analytic sheet with 16 faces a side the measured kink is 0.001 degrees (triangles 0.007); with three
# rings and cubics it is 0.03.
RINGS, DEGREE = 5, 5


@dataclass(frozen=True)
class Border:
    """The border edges of a mesh, and its surface at their ends.

    edge: (b, 2) vertices, with the face on the left; face: (b,) that face. vertex: (k,) the border's
    vertices; by vertex, (k, 3): point, normal, and `inward`, across the border; bend: (k, 3, 3), the
    second fundamental form with that normal, positive where the surface turns towards it.
    """

    edge: np.ndarray
    face: np.ndarray
    vertex: np.ndarray
    point: np.ndarray
    normal: np.ndarray
    inward: np.ndarray
    bend: np.ndarray
    slot: np.ndarray  # (n,): the row of each vertex of the mesh; -1 off the border

    def at(self, points: np.ndarray) -> Foot:
        """The nearest points on the border curve, which lie between its vertices too."""
        start, end = self.slot[self.edge[:, 0]], self.slot[self.edge[:, 1]]
        first, along = self.point[start], self.point[end] - self.point[start]
        length2 = np.maximum(np.einsum("ij,ij->i", along, along), 1e-300)
        share = np.empty(len(points))
        nearest = np.empty(len(points), np.int64)
        for part in np.array_split(np.arange(len(points)), 1 + len(points) * len(first) // 10**6):
            t = np.einsum("pej,ej->pe", points[part, None] - first, along) / length2
            t = np.clip(t, 0, 1)
            gap = points[part, None] - first - t[..., None] * along
            best = np.argmin(np.einsum("pej,pej->pe", gap, gap), axis=1)
            nearest[part], share[part] = best, t[np.arange(len(part)), best]
        a, b, t = start[nearest], end[nearest], share[:, None]
        chord = along[nearest]

        def mean(values: np.ndarray) -> np.ndarray:
            return (1 - t) * values[a] + t * values[b]

        length = np.sqrt(length2[nearest])[:, None]
        tangents = [_unit(np.cross(self.inward[end], self.normal[end])) * length for end in (a, b)]
        swing = (1 - t) * (tangents[0] - chord) - t * (tangents[1] - chord)
        place = self.point[a] + t * chord + t * (1 - t) * swing  # Hermite's cubic
        bend = (1 - t[..., None]) * self.bend[a] + t[..., None] * self.bend[b]
        return Foot(place, _unit(mean(self.normal)), _unit(mean(self.inward)), bend)


@dataclass(frozen=True)
class Foot:
    """A border at p points: the quantities that Border has at vertices, (p, 3) and (p, 3, 3)."""

    point: np.ndarray
    normal: np.ndarray
    inward: np.ndarray
    bend: np.ndarray


def border_edges(corners: np.ndarray, offsets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(b, 2) edges with one face, which is on their left, and (b,) that face."""
    sizes = np.diff(offsets)
    edge = np.stack([corners, corners[following(offsets)]], axis=1)
    key = np.sort(edge, axis=1) @ [int(corners.max(initial=0)) + 1, 1]
    _, place, count = np.unique(key, return_inverse=True, return_counts=True)
    single = np.flatnonzero(count[place.ravel()] == 1)
    return edge[single], np.repeat(np.arange(len(sizes)), sizes)[single]


def border_of(
    points: np.ndarray,
    corners: np.ndarray,
    offsets: np.ndarray,
    rings: int = RINGS,
    only: np.ndarray | None = None,
) -> Border:
    """The border of a mesh. A vertex where two borders meet has the values of one of them. `only`: (j,)
    the border vertices to return; None: all.
    """
    edge, face = border_edges(corners, offsets)
    vertex = np.unique(edge)
    slot = np.full(len(points), -1)
    slot[vertex] = np.arange(len(vertex))
    before, after = (np.full(len(vertex), -1) for _ in range(2))
    after[slot[edge[:, 0]]] = edge[:, 1]
    before[slot[edge[:, 1]]] = edge[:, 0]
    along = _tangents(points, vertex, before, after)
    if only is not None:
        kept = np.isin(edge, only).all(axis=1)
        edge, face, along = edge[kept], face[kept], along[np.isin(vertex, edge[kept])]
        vertex = np.unique(edge)
        slot[:] = -1
        slot[vertex] = np.arange(len(vertex))
    around = _Around(corners, offsets)
    up, near = around.normals(points, vertex), around.rings(vertex, rings)
    normal, inward = np.empty((len(vertex), 3)), np.empty((len(vertex), 3))
    bend = np.empty((len(vertex), 3, 3))
    for k, v in enumerate(vertex):
        others = points[near[k][near[k] != v]] - points[v]
        normal[k], inward[k], bend[k] = _fitted(others, along[k], up[k])
    return Border(edge, face, vertex, points[vertex], normal, inward, bend, slot)


def _tangents(
    points: np.ndarray, vertex: np.ndarray, before: np.ndarray, after: np.ndarray
) -> np.ndarray:
    """Tangents of the border at its vertices, by the parabola through three vertices."""
    back, on = points[vertex] - points[before], points[after] - points[vertex]
    p, q = (np.linalg.norm(side, axis=1, keepdims=True) for side in (back, on))
    return _unit(back * q / p + on * p / q)


class _Around:
    """The faces around each vertex, and their corners."""

    def __init__(self, corners: np.ndarray, offsets: np.ndarray):
        self.corners, self.offsets = corners, offsets
        face = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
        order = np.argsort(corners, kind="stable")
        self.face = face[order]
        self.begin = np.searchsorted(corners[order], np.arange(int(corners.max(initial=0)) + 2))

    def rings(self, vertex: np.ndarray, count: int) -> list[np.ndarray]:
        """For each vertex: the vertices within `count` rings of faces around it, and itself."""
        rows, found = np.arange(len(vertex)), vertex
        size = len(self.begin)
        for _ in range(count):
            of_pair, face = _ranges(self.begin[found], self.begin[found + 1])
            key = np.unique(rows[of_pair] * len(self.offsets) + self.face[face])
            rows, faces = np.divmod(key, len(self.offsets))
            of_pair, corner = _ranges(self.offsets[faces], self.offsets[faces + 1])
            rows, found = np.divmod(np.unique(rows[of_pair] * size + self.corners[corner]), size)
        return np.split(found, np.searchsorted(rows, np.arange(1, len(vertex))))

    def normals(self, points: np.ndarray, vertex: np.ndarray) -> np.ndarray:
        """For each vertex: the sum of the normals of its faces, weighted by twice their areas."""
        of_vertex, place = _ranges(self.begin[vertex], self.begin[vertex + 1])
        face = self.face[place]
        of_face, corner = _ranges(self.offsets[face], self.offsets[face + 1])
        after = following(self.offsets)
        origin = points[vertex][of_vertex[of_face]]  # rounding would matter far from zero
        cross = np.cross(
            points[self.corners[corner]] - origin, points[self.corners[after[corner]]] - origin
        )
        total = np.zeros((len(vertex), 3))
        np.add.at(total, of_vertex[of_face], cross)
        return total


def _ranges(begin: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All numbers of the ranges [begin, end), one range after another, and the range of each number."""
    return np.repeat(np.arange(len(begin)), end - begin), ranges(begin, end)


def _fitted(near: np.ndarray, along: np.ndarray, up: np.ndarray) -> tuple[Any, Any, Any]:
    """Normal, inward direction and second fundamental form, at the origin, of the fitted polynomial."""
    size = np.linalg.norm(near, axis=1).max()
    bend = np.zeros((2, 2))
    for _ in range(3):
        up = up - up @ along * along
        up = up / max(float(np.linalg.norm(up)), 1e-300)
        inward = np.cross(up, along)
        x, y, z = (near @ axis / size for axis in (along, inward, up))
        degree = max(d for d in range(2, DEGREE + 1) if d == 2 or (d + 1) * (d + 2) <= len(near))
        terms = [x, y, x * x / 2, x * y, y * y / 2]
        terms += [x ** (d - k) * y**k for d in range(3, degree + 1) for k in range(d + 1)]
        weight = 1 / (0.1 + x * x + y * y)
        solved = np.linalg.lstsq(weight[:, None] * np.stack(terms, 1), weight * z, rcond=None)[0]
        bend = np.array([[solved[2], solved[3]], [solved[3], solved[4]]]) / size
        along = along + solved[0] * up
        along = along / np.linalg.norm(along)
        up = up - solved[0] * along - solved[1] * inward
    up = up - up @ along * along
    up = up / max(float(np.linalg.norm(up)), 1e-300)
    axes = np.stack([along, np.cross(up, along)])
    return up, axes[1], axes.T @ bend @ axes


def _unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.maximum(length, 1e-300)


@dataclass(frozen=True)
class Joint:
    """A joint of two surfaces along their borders, measured at k places.

    vertex: (k,) border vertices of the first mesh. gap: (k,) the distance to the other's border, mesh
    units. kink: (k,) the angle between the tangent planes, radians. bend: (k, 2) the normal curvatures
    across the joint on both sides, 1 / mesh units. largest: the largest of all
    directions, places and sides.
    """

    vertex: np.ndarray
    gap: np.ndarray
    kink: np.ndarray
    bend: np.ndarray
    largest: float

    @property
    def jump(self) -> np.ndarray:
        """(k,): the curvature's jump, as a share of the largest curvature."""
        return np.abs(self.bend[:, 0] - self.bend[:, 1]) / max(self.largest, 1e-300)


def joint(first: Mesh, other: Mesh, reach: float | None = None) -> Joint:
    """Measures gap, kink and curvatures of two surfaces at the border vertices of the first.

    first, other: (vertices, faces), as fair() takes them, or with Result.faces. reach: mesh units, the
    largest distance of a border vertex of the first from the other's border; None: the mean border edge
    of the first. Ends of the joint and corners, which have no unique tangent, do not count.

    Raises FairingError BAD_SHAPE, and BAD_OPTION for a mesh without a border.
    """
    a, b = (border_of(*mesh_arrays(mesh)) for mesh in (first, other))
    if reach is None:
        reach = float(np.linalg.norm(np.diff(a.point[a.slot[a.edge]], axis=1), axis=2).mean())
    return joint_of(a, b, reach)


def mesh_arrays(mesh: Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points, corners, offsets of (vertices, faces); faces may also be (triangles, quads)."""
    vertices, faces = mesh
    points = vertex_array(vertices)
    if isinstance(faces, tuple) and len(faces) == 2 and np.ndim(faces[0]) == 2:
        parts = [np.asarray(part, np.int64) for part in faces]
        corners = np.concatenate([part.ravel() for part in parts])
        sizes = np.repeat([3, 4], [len(part) for part in parts])
        offsets = np.concatenate([[0], np.cumsum(sizes)])
    else:
        corners, offsets = face_arrays(faces)
    if not len(border_edges(corners, offsets)[0]):
        raise fairing_error("BAD_OPTION", "A mesh that is to meet another has no border.")
    return points, corners, offsets


def joint_of(first: Border, other: Border, reach: float) -> Joint:
    """The joint where the first border is within `reach` of the other, without ends and corners, which
    have no unique tangent."""
    foot = other.at(first.point)
    gap = np.linalg.norm(foot.point - first.point, axis=1)
    near = gap <= reach
    a, b = first.slot[first.edge].T
    inside = np.zeros(len(near), int)
    step = first.point[b] - first.point[a]
    middle = (first.point[a] + first.point[b]) / 2
    aside = np.einsum("kj,kj->k", other.at(middle).point - middle, step)
    length2 = np.einsum("kj,kj->k", step, step)
    both = near[a] & near[b] & (np.abs(aside) < length2 / 4)  # not beyond the end
    np.add.at(inside, a, both)
    np.add.at(inside, b, both)
    turn = np.zeros((2, len(near), 3))
    turn[0, b], turn[1, a] = _unit(step), _unit(step)
    straight = np.einsum("kj,kj->k", turn[0], turn[1]) > np.cos(np.radians(30))
    chosen = np.flatnonzero(near & (inside == 2) & straight)
    inward, across = first.inward[chosen], foot.inward[chosen]
    along = np.cross(first.normal[chosen], inward)
    across = _unit(across - np.einsum("kj,kj->k", across, along)[:, None] * along)
    lean = np.einsum("kj,kj->k", first.normal[chosen], across)
    kink = np.abs(np.arctan2(lean, -np.einsum("kj,kj->k", inward, across)))
    bends = [
        np.einsum("ki,kij,kj->k", inward, first.bend[chosen], inward),
        np.einsum("ki,kij,kj->k", across, foot.bend[chosen], across),
    ]
    alike = np.sign(np.einsum("kj,kj->k", first.normal[chosen], foot.normal[chosen]))
    every = np.concatenate([first.bend[chosen], foot.bend[chosen]])
    largest = float(np.abs(np.linalg.eigvalsh(every)).max(initial=0.0)) if len(every) else 0.0
    across_both = np.stack([bends[0], alike * bends[1]], axis=1)
    return Joint(first.vertex[chosen], gap[chosen], kink, across_both, largest)
