# SPDX-License-Identifier: GPL-3.0-or-later
"""Holes of a mesh closed in place by the fairest surface: which they are, and the faces that fill them."""

from collections.abc import Hashable, Iterable
from dataclasses import dataclass
from time import perf_counter
from typing import Any, cast

import bmesh
import numpy as np

from . import core, errors, prediction
from .blender import Context, Object
from .errors import JobCancelled, JobError
from .mesh.object import Reference
from .mesh.read import control_mesh, read_mesh
from .mesh.world_shape import world_shape
from .mesh.write_filling import write_hole
from .transfer.cut_out import cut_out

Pair = frozenset[int]  # the two vertices of an edge


@dataclass(frozen=True)
class Wish:
    joint: str  # POSITION, TANGENT, CURVATURE
    energy: str
    density: float
    most_edges: int  # in Object Mode: larger holes stay open
    replaces: (
        bool  # in Edit Mode: whether the selected faces are erased, or border edges name holes
    )


@dataclass(frozen=True)
class Filling:
    """What has been done to a mesh."""

    holes: int = 0
    faces: int = 0  # new ones
    plates: int = 0  # holes that the thin plate fills in place of another energy
    folded: int = 0


class HoleJob:
    """The holes of one object: read, filled on any thread, then applied. What keeps them from being
    filled becomes `reason`, so that other objects need not suffer.
    """

    def __init__(self, context: Context, target: Object, wish: Wish) -> None:
        """Reads; JobError says why that cannot be."""
        self.name, self._target, self._wish = target.name, Reference(target), wish
        self._mode, self._shape = target.mode, world_shape(target)
        self.result: Any = None
        self.reason = ""
        with control_mesh(context, target) as mesh:
            self._arrays = arrays = read_mesh(mesh)
            gone = np.zeros(len(arrays.face_sizes), bool)
            edges = np.zeros(len(arrays.edges), bool)
            if self._editing:
                mesh.polygons.foreach_get("select", gone)
                mesh.edges.foreach_get("select", edges)
            if not wish.replaces:
                gone[:] = False
        self._gone = gone
        self._points = self._shape.of(arrays.positions)
        loops = _loops(arrays, self._points, gone)
        if not self._editing:
            self._holes = [[loop] for loop in loops if len(loop) <= wish.most_edges]
        elif wish.replaces:
            self._holes = _where_faces_were(arrays, gone, loops)
        else:
            chosen = set(map(frozenset, arrays.edges[edges].tolist()))
            self._holes = [[loop] for loop in loops if not chosen.isdisjoint(_sides(loop))]
        if not self._holes:
            raise JobError(f"{self.name}: {_none_text(wish, self._editing)}")
        self.triangles = sum(_triangles_in(sum(map(len, h)), wish.density) for h in self._holes)

    @property
    def _editing(self) -> bool:
        return self._mode == "EDIT"

    @property
    def _key(self) -> Hashable:
        """For predictions."""
        return "holes", self._target.key

    @property
    def predicted_seconds(self) -> float:
        """How long `compute` will take."""
        return prediction.seconds(self._wish.energy, self.triangles, self._key)

    def compute(self, **watchers: Any) -> None:
        """Runs the core; `watchers` are its `monitor` and `progress`."""
        begun = perf_counter()
        try:
            with errors.explained(self.name):
                self.result = core.module().fill_holes(
                    self._points,
                    _flat(self._arrays, ~self._gone),
                    holes=self._holes,
                    joint=self._wish.joint.lower(),
                    energy=self._wish.energy.lower(),
                    density=self._wish.density,
                    **watchers,
                )
        except JobCancelled:
            raise
        except JobError as error:
            self.reason = str(error)
        self._taken = perf_counter() - begun

    def why_outdated(self, context: Context) -> str:
        """Why what was computed does not fit any more, in one sentence; empty if it does."""
        target = self._target.find()
        if target is None:
            return f"{self.name} was deleted or undone during the run: nothing has changed."
        if target.mode == self._mode:
            with control_mesh(context, target) as mesh:
                now = read_mesh(mesh)
            if (
                core.same_faces(now, self._arrays)
                and np.array_equal(now.positions, self._arrays.positions)
                and self._shape == world_shape(target)
            ):
                return ""
        return f"{self.name} was edited during the run: its holes are as they were. Fill them once more."

    def apply(self) -> Filling:
        """Makes the faces."""
        target, filled = cast(Object, self._target.find()), self.result
        places = self._shape.back(filled.vertices, self._points, self._arrays.positions)
        bm = bmesh.from_edit_mesh(target.data) if self._editing else bmesh.new()
        try:
            if not self._editing:
                bm.from_mesh(target.data)
            _write(bm, np.flatnonzero(self._gone), filled, places)
            if self._editing:
                bmesh.update_edit_mesh(target.data)
            else:
                bm.to_mesh(target.data)
                target.data.update()
        finally:
            if not self._editing:
                bm.free()
        prediction.note(self._wish.energy, self.triangles, self._taken, self._key)
        return Filling(
            len(filled.holes),
            len(filled.new_faces),
            sum(h.energy not in (self._wish.energy.lower(), "none") for h in filled.holes),
            sum(h.folds > 0 for h in filled.holes),
        )


def _triangles_in(edges: int, density: float) -> int:
    """Of a round flat hole with so many edges around, in equilateral triangles."""
    return edges + round((edges * density) ** 2 / (np.sqrt(3.0) * np.pi))


def _flat(arrays: core.ControlArrays, kept: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The corners and offsets of the faces `kept` (m,) bool."""
    sizes = arrays.face_sizes
    corners = arrays.corners[np.repeat(kept, sizes)]
    return corners.astype(np.int64), np.concatenate([[0], np.cumsum(sizes[kept])]).astype(np.int64)


def _loops(arrays: core.ControlArrays, points: np.ndarray, gone: np.ndarray) -> list[list[int]]:
    """Around the holes that are there without the faces `gone`: only those at a border are looked at."""
    kept = np.repeat(~gone, arrays.face_sizes)
    uses = np.bincount(arrays.corner_edges[kept], minlength=len(arrays.edges))
    border = arrays.edges[uses == 1]
    at_border = np.zeros(len(points), bool)
    at_border[border] = True
    face_of = np.repeat(np.arange(len(gone)), arrays.face_sizes)
    near = np.zeros(len(gone), bool)
    near[face_of[at_border[arrays.corners] & kept]] = True
    if not near.any():
        return []
    part = cut_out(arrays, near)
    found = core.module().find_holes(
        points[part.vertices], _flat(part.arrays, np.ones(len(part.faces), bool))
    )
    loops = [part.vertices[loop].tolist() for loop in found]
    sides = set(map(frozenset, border.tolist()))
    return [loop for loop in loops if sides.issuperset(_sides(loop))]


def _none_text(wish: Wish, editing: bool) -> str:
    if not editing:
        return f"there is no hole of at most {wish.most_edges} edges. Raise Largest Hole"
    if wish.replaces:
        return "the selected faces leave no hole. Select faces with others around them"
    return "no border edge of a hole is selected. Select one, or in Face Mode faces to be replaced"


def _sides(loop: list[int]) -> Iterable[Pair]:
    return (frozenset(pair) for pair in zip(loop, [*loop[1:], loop[0]], strict=True))


def _where_faces_were(
    arrays: core.ControlArrays, gone: np.ndarray, loops: list[list[int]]
) -> list[list[list[int]]]:
    """The loops around each connected part of the erased faces: its rim, the longest, then islands."""
    faces = np.flatnonzero(gone).tolist()
    edges_of = {f: arrays.corner_edges[arrays.offsets[f] : arrays.offsets[f + 1]] for f in faces}
    faces_at: dict[int, list[int]] = {}
    for face, edges in edges_of.items():
        for edge in edges.tolist():
            faces_at.setdefault(edge, []).append(face)
    part_of: dict[int, int] = {}
    for first in faces:
        stack = [] if first in part_of else [first]
        part_of.setdefault(first, len(part_of))
        while stack:
            beside = {f for e in edges_of[stack.pop()].tolist() for f in faces_at[e]}
            fresh = [f for f in beside if f not in part_of]
            part_of.update(dict.fromkeys(fresh, part_of[first]))
            stack += fresh
    uses = arrays.edge_uses
    rim = {
        frozenset(arrays.edges[edge].tolist()): part_of[at[0]]
        for edge, at in faces_at.items()
        if len(at) < uses[edge]
    }
    holes: dict[int, list[list[int]]] = {}
    for loop in loops:
        part = next((rim[side] for side in _sides(loop) if side in rim), None)
        if part is not None:
            holes.setdefault(part, []).append(loop)
    return [sorted(hole, key=len, reverse=True) for _, hole in sorted(holes.items())]


def _write(bm: Any, gone: np.ndarray, filled: Any, places: np.ndarray) -> None:
    """The filling, selected, in the place of the faces `gone` (ids)."""
    old = list(bm.verts)
    bm.faces.ensure_lookup_table()
    bmesh.ops.delete(bm, geom=[bm.faces[f] for f in gone.tolist()], context="FACES")
    for parts in (bm.faces, bm.edges, bm.verts):
        for part in [p for p in parts if p.select]:
            part.select = False
    faces = np.asarray(_triangles(filled))
    made: list[Any] = []
    for hole in filled.holes:
        chosen = faces[hole.faces.start : hole.faces.stop]
        made += write_hole(bm, old, filled.vertices, chosen, places)
    for face in made:
        face.normal_update()
        face.select_set(True)


def _triangles(filled: Any) -> Any:
    """(M, 3), of which only the rows of new faces count."""
    if not isinstance(filled.faces, tuple):
        return filled.faces
    corners, offsets = filled.faces
    return corners[offsets[:-1, None] + np.arange(3)]
