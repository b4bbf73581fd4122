# SPDX-License-Identifier: GPL-3.0-or-later
"""Holes of a mesh closed in place by the fairest surface: which they are, and the faces that fill them."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import bmesh
import numpy as np

from . import core, errors
from .blender import Object
from .errors import JobError
from .mesh.world_shape import world_shape

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


def fill_holes(target: Object, wish: Wish) -> Filling:
    """Fills holes of `target`: in Edit Mode those that are selected, else all small ones. Raises
    JobError where there is none, or where one cannot be filled; the mesh is as before then.
    """
    editing = target.mode == "EDIT"
    bm = bmesh.from_edit_mesh(target.data) if editing else bmesh.new()
    try:
        if not editing:
            bm.from_mesh(target.data)
        with errors.explained(target.name):
            filling = _fill(target, bm, wish, editing)
        if editing:
            bmesh.update_edit_mesh(target.data)
        else:
            bm.to_mesh(target.data)
            target.data.update()
    finally:
        if not editing:
            bm.free()
    return filling


def _fill(target: Object, bm: Any, wish: Wish, editing: bool) -> Filling:
    bm.verts.index_update()
    own = np.array([v.co for v in bm.verts], np.float64).reshape(-1, 3)
    shape = world_shape(target)
    points = shape.of(own)
    gone = [f for f in bm.faces if f.select] if editing and wish.replaces else []
    erased = set(gone)
    kept = [[v.index for v in f.verts] for f in bm.faces if f not in erased]
    loops = [loop.tolist() for loop in core.module().find_holes(points, kept)] if kept else []
    if not editing:
        holes = [[loop] for loop in loops if len(loop) <= wish.most_edges]
    elif wish.replaces:
        holes = _where_faces_were(gone, loops)
    else:
        chosen = {_pair(e) for e in bm.edges if e.select and e.is_boundary}
        holes = [[loop] for loop in loops if not chosen.isdisjoint(_sides(loop))]
    if not holes:
        raise JobError(f"{target.name}: {_none_text(wish, editing)}")
    filled = core.module().fill_holes(
        points,
        kept,
        holes=holes,
        joint=wish.joint.lower(),
        energy=wish.energy.lower(),
        density=wish.density,
    )
    _write(bm, gone, filled, shape.back(filled.vertices, points, own))
    return Filling(
        len(filled.holes),
        len(filled.new_faces),
        sum(h.energy not in (wish.energy.lower(), "none") for h in filled.holes),
        sum(h.folds > 0 for h in filled.holes),
    )


def _none_text(wish: Wish, editing: bool) -> str:
    if not editing:
        return f"there is no hole of at most {wish.most_edges} edges. Raise Largest Hole"
    if wish.replaces:
        return "the selected faces leave no hole. Select faces with others around them"
    return "no border edge of a hole is selected. Select one, or in Face Mode faces to be replaced"


def _pair(edge: Any) -> Pair:
    return frozenset(v.index for v in edge.verts)


def _sides(loop: list[int]) -> Iterable[Pair]:
    return (frozenset(pair) for pair in zip(loop, [*loop[1:], loop[0]], strict=True))


def _where_faces_were(gone: list[Any], loops: list[list[int]]) -> list[list[list[int]]]:
    """The loops around each connected part of the erased faces: its rim, the longest, then islands."""
    part_of: dict[Any, int] = {}
    erased = set(gone)
    for first in gone:
        stack = [] if first in part_of else [first]
        part_of.setdefault(first, len(part_of))
        while stack:
            beside = {f for e in stack.pop().edges for f in e.link_faces if f in erased}
            fresh = [f for f in beside if f not in part_of]
            part_of.update(dict.fromkeys(fresh, part_of[first]))
            stack += fresh
    rim = {
        _pair(e): part_of[f] for f in gone for e in f.edges if not erased.issuperset(e.link_faces)
    }
    holes: dict[int, list[list[int]]] = {}
    for loop in loops:
        part = next((rim[side] for side in _sides(loop) if side in rim), None)
        if part is not None:
            holes.setdefault(part, []).append(loop)
    return [sorted(hole, key=len, reverse=True) for _, hole in sorted(holes.items())]


def _write(bm: Any, gone: list[Any], filled: Any, places: np.ndarray) -> None:
    """New vertices and faces take what the nearest vertex of the rim, and the face there, have."""
    old = list(bm.verts)
    bmesh.ops.delete(bm, geom=gone, context="FACES")
    for part in (*bm.faces, *bm.edges, *bm.verts):
        part.select = False
    keys = list(bm.verts.layers.shape.values())
    faces = np.asarray(_triangles(filled))
    made: list[Any] = []
    for hole in filled.holes:
        rim = np.concatenate([np.asarray(loop) for loop in hole.loops])
        beside: dict[int, Any] = {v: next(iter(old[v].link_loops), None) for v in rim.tolist()}
        nearest = {v: v for v in rim.tolist()}
        new: dict[int, Any] = {v: old[v] for v in nearest}
        for v in hole.vertices:
            distance = np.linalg.norm(filled.vertices[rim] - filled.vertices[v], axis=1)
            nearest[v] = int(rim[distance.argmin()])
            new[v] = bm.verts.new(places[v], old[nearest[v]])
            new[v].co = places[v]
            for key in keys:
                new[v][key] = new[v].co
        for corners in faces[hole.faces.start : hole.faces.stop].tolist():
            loop = beside[nearest[corners[0]]]
            face = bm.faces.new([new[v] for v in corners], None if loop is None else loop.face)
            for corner, v in zip(face.loops, corners, strict=True):
                if beside[nearest[v]] is not None:
                    corner.copy_from(beside[nearest[v]])
            made.append(face)
    for face in made:
        face.select_set(True)
    bm.normal_update()


def _triangles(filled: Any) -> Any:
    """(M, 3), of which only the rows of new faces count."""
    if not isinstance(filled.faces, tuple):
        return filled.faces
    corners, offsets = filled.faces
    return corners[offsets[:-1, None] + np.arange(3)]
