# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with a surface that came out: it crosses itself, runs away, or folds.

Steps that have converged may have ended in such a surface all the same. Computed with the job, on
any thread; `mathutils` is not part of Blender's data.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from mathutils.bvhtree import BVHTree

from ..blender import Mesh
from ..core import ControlArrays, folds, module
from ..inspection.curvature import cross
from ..mesh.layers import fill_layer, layer_values, make_layer
from ..mesh.write import FAULTS
from ..transfer.attributes import AttributeTransfer
from ..transfer.coarse import coarse_triangles
from .folds import folded, folded_in_place

# triangles that are searched for crossings at a time, some 0.3 seconds; a finer surface is looked at
# by fewer of its points first
MOST = 40_000
# times the length of the edges around: spheres from the vertices of a cube or tetrahedron are at 0.4,
# inner walls that have broken through the outer ones at 1.5 and more
FAR = 1.0
_SHARP = -0.5  # cosine of 120 degrees


@dataclass(frozen=True)
class Faults:
    """(N,) bool: at which vertices of a surface something is wrong."""

    crossing: np.ndarray  # through another part of the surface, where the control mesh does not
    far: np.ndarray  # farther from the control mesh than its edges are long there
    folded: np.ndarray  # at edges where the surface turns back

    @property
    def counts(self) -> dict[str, int]:
        """By kind, those that there are any of."""
        all_of_them = {name: int(getattr(self, name).sum()) for name in FAULTS}
        return {name: count for name, count in all_of_them.items() if count}

    def write(self, mesh: Mesh) -> None:
        """As attributes of the vertices, one a kind."""
        for name in self.counts:
            fill_layer(make_layer(mesh, FAULTS[name], "BOOLEAN", "POINT"), getattr(self, name))


def faulty_vertices(mesh: Mesh) -> np.ndarray:
    """Ids of the vertices of `mesh` that `write` has marked."""
    marked = np.zeros(len(mesh.vertices), bool)
    for name in FAULTS.values():
        if name in mesh.attributes:
            marked |= layer_values(mesh.attributes[name])
    return np.flatnonzero(marked)


def find_faults(result: Any, transfer: AttributeTransfer, control: ControlArrays) -> Faults:
    """Of the core's `result` for the mesh `control`, both in the same coordinates."""
    none = np.zeros(len(result.vertices), bool)
    before = transfer.point(control.positions)
    return Faults(
        _crossing(result.vertices, before, transfer),
        _departure(result.vertices, transfer, control) > FAR,
        folded(result.vertices, result.triangles) if folds(result.report) else none,
    )


def find_faults_in_place(
    result: Any,
    transfer: AttributeTransfer,
    control: ControlArrays,
    chosen: np.ndarray,
    options: Any,
) -> Faults:
    """The same of the `chosen` (m,) bool faces of a part of a mesh, faired by `options` (in_place.InPlaceOptions).

    With no levels only the part's own vertices count. Where these move, they go as far as they may,
    which is no fault.
    """
    before, vertices = transfer.point(control.positions), result.vertices
    if not options.levels:
        vertices = transfer.point(vertices[: len(control.positions)])
    joined = options.joint != "POSITION"
    near = np.zeros(len(vertices), bool)
    return Faults(
        _crossing(vertices, before, transfer),
        near if options.moves else _departure(vertices, transfer, control) > FAR,
        folded_in_place(result, vertices, before, transfer, chosen, options.levels, joined),
    )


def _departure(
    vertices: np.ndarray, transfer: AttributeTransfer, control: ControlArrays
) -> np.ndarray:
    """(N,) from each vertex to its place on the control mesh, in lengths of the edges around."""
    ends = control.positions[control.edges]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    count = len(control.positions)
    sums = np.bincount(control.edges.ravel(), np.repeat(length, 2), count)
    size = sums / np.maximum(np.bincount(control.edges.ravel(), minlength=count), 1)
    away = np.linalg.norm(vertices - transfer.point(control.positions), axis=1)
    around = transfer.point(size).ravel()
    return away / np.where(around > 0.0, around, np.inf)


def _crossing(vertices: np.ndarray, before: np.ndarray, transfer: AttributeTransfer) -> np.ndarray:
    """(N,) bool: where the surface at `vertices` crosses itself and the control mesh, `before`, does
    not.
    """
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
        # two close walls may seem to cross by few points only: a second look, nearer
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
    """Triangles (t, 3) over the `chosen` control faces, which are `count` triangles, as fine as may
    be; pairs (p, 2) of those that cross; and (t,) the control face of each.
    """
    levels = 0
    while levels < transfer.levels and count * 4 ** (levels + 1) <= MOST:
        levels += 1
    triangles, faces = coarse_triangles(transfer, levels)
    here = chosen[faces]
    triangles, faces = triangles[here], faces[here]
    return triangles, _pairs(vertices, triangles), faces


def _pairs(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(p, 2) triangles that cross, but for those that share an edge, each pair once. (The tree, in
    single precision, also takes some for crossing that touch in a vertex of both.)
    """
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
    """The `triangles` (t, 3), the one corner `chosen` (t, 3) of each in front."""
    return np.take_along_axis(
        triangles, (chosen.argmax(axis=1)[:, None] + np.arange(3)) % 3, axis=1
    )


def _pierced(triangles: np.ndarray, others: np.ndarray) -> np.ndarray:
    """(t,) bool: whether the last sides of `others` pass through `triangles`, both (t, 3, 3), with
    the same first corner [Möller and Trumbore 1997].
    """
    u, v = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    start = others[:, 1] - triangles[:, 0]
    way = others[:, 2] - others[:, 1]
    across = cross(way, v)
    determinant = (u * across).sum(axis=1)
    inverse = 1.0 / np.where(determinant == 0.0, np.inf, determinant)
    turned = cross(start, u)
    a, b, along = (
        inverse * (x * y).sum(axis=1) for x, y in ((start, across), (way, turned), (v, turned))
    )
    return np.minimum.reduce([a, b, 1.0 - a - b, along, 1.0 - along]) > 1e-6


class _Excused:
    """Where the control mesh crosses itself, is folded sharply, or is open between vertices that lie
    on one another, its surface may well cross itself too: eyes in a head, the rim of a nostril.
    """

    def __init__(self, vertices: np.ndarray, triangles: np.ndarray, faces: np.ndarray) -> None:
        """`triangles` (t, 3) of the control mesh, of its `faces` (t,)."""
        count = int(faces.max()) + 1
        self._part = _parts(triangles, faces, count)
        crossing = faces[_pairs(vertices, triangles)]
        self._parts = {_ordered(a, b) for a, b in self._part[crossing].tolist() if a != b}
        # within a part: faces that do, and their neighbours
        self._near = np.zeros(count, bool)
        at = _on_others(vertices, triangles) | folded(vertices, triangles, _SHARP)
        own = crossing[self._part[crossing[:, 0]] == self._part[crossing[:, 1]]]
        at[triangles[np.isin(faces, own) | at[triangles].any(axis=1)]] = True
        self._near[faces[at[triangles].any(axis=1)]] = True

    def leave_out(self, pairs: np.ndarray, faces: np.ndarray) -> np.ndarray:
        """The `pairs` (p, 2) of triangles, of control `faces` (t,), that are to be told."""
        ends = faces[pairs]
        parts = self._part[ends]
        crossing = [_ordered(a, b) not in self._parts for a, b in parts.tolist()]
        same = parts[:, 0] == parts[:, 1]
        return pairs[np.array(crossing, bool) & ~(same & self._near[ends].all(axis=1))]


def _on_others(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(N,) bool: vertices of the `triangles` that lie on others."""
    used = np.unique(triangles)
    _, place, count = np.unique(vertices[used], axis=0, return_inverse=True, return_counts=True)
    on = np.zeros(len(vertices), bool)
    on[used[count[place.ravel()] > 1]] = True
    return on


def _ordered(a: int, b: int) -> tuple[int, int]:
    return (a, b) if a < b else (b, a)


def _parts(triangles: np.ndarray, faces: np.ndarray, count: int) -> np.ndarray:
    """(count,) a number for each control face, the same within a connected part."""
    pairs = triangles[:, [[0, 1], [1, 2]]].reshape(-1, 2)
    label = module().patches.connected_parts(int(triangles.max()) + 1, pairs)
    part = np.zeros(count, np.int64)
    part[faces] = label[triangles[:, 0]]
    return part
