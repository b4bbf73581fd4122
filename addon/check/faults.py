# SPDX-License-Identifier: GPL-3.0-or-later
"""Faults of a new surface: it crosses itself, departs far from the control mesh, or folds.

Even converged steps may end in such a surface. Computed with the job, on any thread, which `mathutils`
allows.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from mathutils.bvhtree import BVHTree

from ..blender import Mesh
from ..core import ControlArrays, folds, measured, module
from ..mesh.layers import fill_layer, layer_values, make_layer
from ..mesh.write import FAULTS
from ..transfer.attributes import AttributeTransfer, coarse_triangles
from ..transfer.seams import mark_pairs
from ..triangles import marked, unit


def folded(vertices: np.ndarray, triangles: np.ndarray, cosine: float = 0.0) -> np.ndarray:
    """(N,) bool: the ends of edges whose two triangles have normals with a cosine below `cosine`."""
    return marked(_folds(vertices, triangles, cosine)[0], len(vertices))


def outward_folds(vertices: np.ndarray, triangles: np.ndarray, cosine: float) -> np.ndarray:
    """(k, 2) the triangles at edges folded so, with the surface's inside between them."""
    _, sides = _folds(vertices, triangles, cosine)
    corners = vertices[triangles]
    ways = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outside = np.sign((corners[:, 0] * ways).sum())  # of a closed mesh
    middles = corners.mean(axis=1)
    apart = middles[sides[:, 1]] - middles[sides[:, 0]]
    return sides[outside * (apart * ways[sides[:, 0]]).sum(axis=1) < 0.0]


def folded_in_place(
    result: Any,
    vertices: np.ndarray,
    before: np.ndarray,
    transfer: AttributeTransfer,
    chosen: np.ndarray,
    joined: bool,
) -> np.ndarray:
    """(N,) bool: vertices at folds of the `chosen` control faces, (m,) bool, of the core's `result`,
    with its points at `vertices` (N, 3).

    `joined`: whether the faces must meet those around smoothly; otherwise any angle is right there.
    Creases do not count, nor do folds of the control mesh, which is at `before`, and of the faces at
    them.
    """
    polygon = np.concatenate([patch.faces.polygon for patch in transfer.patches])
    coarsest, owner = coarse_triangles(transfer, 0)
    theirs = chosen[polygon]
    edges, sides = _folds(before, coarsest)
    at = marked(edges[theirs[owner[sides]].all(axis=1)], len(vertices))
    excused = marked(owner[at[coarsest].any(axis=1)], len(polygon))
    edges, sides = _folds(vertices, coarsest)
    inside = theirs[owner[sides]]
    counted = inside.all(axis=1) & ~excused[owner[sides]].any(axis=1)
    if joined:
        counted |= inside.any(axis=1) & ~inside.all(axis=1)
    return marked(edges[counted & ~mark_pairs(edges, result.crease_edges)], len(vertices))


def _folds(
    vertices: np.ndarray, triangles: np.ndarray, cosine: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """(k, 2) the ends of the folded edges, and (k, 2) their triangles."""
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    normals = unit(np.cross(b - a, c - a))
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    keys = module().arrays.pair_keys(edges)
    order = np.argsort(keys, kind="stable")
    pairs = np.flatnonzero(keys[order][1:] == keys[order][:-1])
    first, second = order[pairs], order[pairs + 1]
    against = (normals[first // 3] * normals[second // 3]).sum(axis=1) < cosine
    sides = np.stack([first, second], axis=1)[against] // 3
    return edges[first[against]], sides


# triangles that are searched for crossings at a time, about 0.3 seconds; of a finer surface fewer
# points are tested first
MOST = 40_000
# in lengths of the edges around: spheres from the vertices of a cube or tetrahedron reach 0.4, inner
# walls that have broken through the outer ones 1.5 and more
FAR = 1.0
_SHARP = -0.5  # cosine of 120 degrees


@dataclass(frozen=True)
class Faults:
    """(N,) bool for each fault: the vertices of a surface that have it."""

    # at crossings with another part of the surface, if the control mesh does not cross itself there
    crossing: np.ndarray
    far: np.ndarray  # farther from the control mesh than the length of its edges there
    folded: np.ndarray  # at edges where the surface folds back

    @property
    def counts(self) -> dict[str, int]:
        """Number of vertices by fault, without zeros."""
        all_of_them = {name: int(getattr(self, name).sum()) for name in FAULTS}
        return {name: count for name, count in all_of_them.items() if count}

    def write(self, mesh: Mesh) -> None:
        """Writes the faults as attributes of the vertices, one for each fault."""
        for name in self.counts:
            fill_layer(make_layer(mesh, FAULTS[name], "BOOLEAN", "POINT"), getattr(self, name))


def faulty_vertices(mesh: Mesh) -> np.ndarray:
    """Ids of the vertices of `mesh` marked by `write`."""
    marked = np.zeros(len(mesh.vertices), bool)
    for name in FAULTS.values():
        if name in mesh.attributes:
            marked |= layer_values(mesh.attributes[name])
    return np.flatnonzero(marked)


def find_faults(result: Any, transfer: AttributeTransfer, control: ControlArrays) -> Faults:
    """The faults of the core's `result` for the mesh `control`, in the same coordinates."""
    none = np.zeros(len(result.vertices), bool)
    before = transfer.point(control.positions)
    return Faults(
        _crossing(result.vertices, before, transfer),
        _departure(result.vertices, transfer, control) > FAR,
        folded(result.vertices, result.triangles) if folds(result.report) else none,
    )


def find_faults_in_place(
    result: Any, transfer: AttributeTransfer, control: ControlArrays, chosen: np.ndarray, joint: str
) -> Faults:
    """The same for the `chosen` faces, (m,) bool, of a part of a mesh, whose vertices have moved. Only
    these count, and any distance is right.
    """
    before = transfer.point(control.positions)
    vertices = transfer.point(result.vertices[: len(control.positions)])
    return Faults(
        _crossing(vertices, before, transfer),
        np.zeros(len(vertices), bool),
        folded_in_place(result, vertices, before, transfer, chosen, joint != "POSITION"),
    )


def _departure(
    vertices: np.ndarray, transfer: AttributeTransfer, control: ControlArrays
) -> np.ndarray:
    """(N,) each vertex's distance from its place on the control mesh, along the normal there, in lengths of its
    edges: in flat faces with many corners a surface may slide by several.
    """
    count, mesh = len(control.positions), measured(control)
    sums = np.bincount(control.edges.ravel(), np.repeat(mesh.edge_lengths, 2), count)
    size = sums / np.maximum(np.bincount(control.edges.ravel(), minlength=count), 1)
    normals = np.zeros((count, 3))
    np.add.at(normals, control.corners, mesh.face_vectors[control.face_of])
    way = unit(transfer.point(normals))
    away = np.abs(((vertices - transfer.point(control.positions)) * way).sum(axis=1))
    around = transfer.point(size).ravel()
    return away / np.where(around > 0.0, around, np.inf)


def _crossing(vertices: np.ndarray, before: np.ndarray, transfer: AttributeTransfer) -> np.ndarray:
    """(N,) bool: where the surface crosses itself and the control mesh, at `before`, does not."""
    marked = np.zeros(len(vertices), bool)
    coarsest, owner = coarse_triangles(transfer, 0)
    if not 0 < len(coarsest) <= MOST:
        return marked
    everywhere = np.ones(owner.max() + 1, bool)
    triangles, pairs, faces = _look(vertices, transfer, len(coarsest), everywhere)
    if len(pairs):
        excused = _Excused(before, coarsest, owner)
        pairs = excused.leave_out(pairs, faces)
    if len(pairs) and len(triangles) < transfer.triangle_count:
        # with few points two close walls may seem to cross: test again with more
        involved = np.zeros_like(everywhere)
        involved[faces[pairs]] = True
        count = int(involved[owner].sum())
        triangles, pairs, faces = _look(vertices, transfer, count, involved)
        pairs = excused.leave_out(pairs, faces)
    marked[triangles[pairs]] = True
    return marked


def _look(
    vertices: np.ndarray, transfer: AttributeTransfer, count: int, chosen: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Triangles (t, 3) over the `chosen` control faces, which have `count` control triangles, as fine
    as the limit allows; pairs (p, 2) of crossing triangles; and (t,) the control face of each.
    """
    levels = 0
    while levels < transfer.levels and count * 4 ** (levels + 1) <= MOST:
        levels += 1
    triangles, faces = coarse_triangles(transfer, levels)
    here = chosen[faces]
    triangles, faces = triangles[here], faces[here]
    return triangles, _pairs(vertices, triangles), faces


def _pairs(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(p, 2) crossing triangles without a common edge, each pair once."""
    used, local = np.unique(triangles, return_inverse=True)
    tree: Any = BVHTree.FromPolygons(
        vertices[used].tolist(), local.reshape(-1, 3).tolist(), all_triangles=True
    )
    found = np.array(tree.overlap(tree), np.int64).reshape(-1, 2)
    found = found[found[:, 0] < found[:, 1]]
    first, second = triangles[found[:, 0]], triangles[found[:, 1]]
    same = first[:, :, None] == second[:, None, :]
    at = np.flatnonzero(same.sum(axis=(1, 2)) == 1)
    first, second = (
        vertices[_turned(corners[at], same[at].any(axis=axis))].astype(np.float64)
        for corners, axis in ((first, 2), (second, 1))
    )
    kept = np.ones(len(found), bool)
    kept[at] = _pierced(first, second) | _pierced(second, first)
    return found[kept]


def _turned(triangles: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """The `triangles` (t, 3), rotated so that the corner `chosen` (t, 3) comes first."""
    return np.take_along_axis(
        triangles, (chosen.argmax(axis=1)[:, None] + np.arange(3)) % 3, axis=1
    )


def _pierced(triangles: np.ndarray, others: np.ndarray) -> np.ndarray:
    """(t,) bool: the last side of `others` crosses `triangles` [Möller and Trumbore 1997]."""
    u, v = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    start = others[:, 1] - triangles[:, 0]
    way = others[:, 2] - others[:, 1]
    across = np.cross(way, v)
    determinant = (u * across).sum(axis=1)
    inverse = 1.0 / np.where(determinant == 0.0, np.inf, determinant)
    turned = np.cross(start, u)
    a, b, along = (
        inverse * (x * y).sum(axis=1) for x, y in ((start, across), (way, turned), (v, turned))
    )
    return np.minimum.reduce([a, b, 1.0 - a - b, along, 1.0 - along]) > 1e-6


class _Excused:
    """Places where a surface may cross itself, because the control mesh crosses itself, folds sharply,
    or is open between coincident vertices: eyes in a head, the rim of a nostril. But walls that meet at a
    fold outwards, such as those of a fin, may not cross.
    """

    def __init__(self, vertices: np.ndarray, triangles: np.ndarray, faces: np.ndarray) -> None:
        """`triangles` (t, 3) of the control mesh, and the face (t,) of each."""
        count = int(faces.max()) + 1
        self._part = _parts(triangles, faces, count)
        crossing = faces[_pairs(vertices, triangles)]
        self._parts = {_ordered(a, b) for a, b in self._part[crossing].tolist() if a != b}
        # within a connected part: crossing faces and their neighbours
        self._near = np.zeros(count, bool)
        at = _on_others(vertices, triangles) | folded(vertices, triangles, _SHARP)
        own = crossing[self._part[crossing[:, 0]] == self._part[crossing[:, 1]]]
        at[triangles[np.isin(faces, own) | at[triangles].any(axis=1)]] = True
        self._near[faces[at[triangles].any(axis=1)]] = True
        walls = faces[outward_folds(vertices, triangles, _SHARP)]
        self._walls = {_ordered(a, b) for a, b in walls.tolist()}

    def leave_out(self, pairs: np.ndarray, faces: np.ndarray) -> np.ndarray:
        """The `pairs` (p, 2) of triangles, of control `faces` (t,), that count as faults."""
        ends = faces[pairs]
        parts = self._part[ends]
        crossing = [_ordered(a, b) not in self._parts for a, b in parts.tolist()]
        same = parts[:, 0] == parts[:, 1]
        excused = same & self._near[ends].all(axis=1)
        excused &= [_ordered(a, b) not in self._walls for a, b in ends.tolist()]
        return pairs[np.array(crossing, bool) & ~excused]


def _on_others(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(N,) bool: vertices of the `triangles` that coincide with others."""
    used = np.unique(triangles)
    _, place, count = np.unique(vertices[used], axis=0, return_inverse=True, return_counts=True)
    return marked(used[count[place.ravel()] > 1], len(vertices))


def _ordered(a: int, b: int) -> tuple[int, int]:
    return (a, b) if a < b else (b, a)


def _parts(triangles: np.ndarray, faces: np.ndarray, count: int) -> np.ndarray:
    """(count,) numbers of control faces, equal within a connected part."""
    pairs = triangles[:, [[0, 1], [1, 2]]].reshape(-1, 2)
    label = module().arrays.connected_parts(int(triangles.max()) + 1, pairs)
    part = np.zeros(count, np.int64)
    part[faces] = label[triangles[:, 0]]
    return part
