# SPDX-License-Identifier: GPL-3.0-or-later
"""Repairs of the user's own mesh, one for each button, by BMesh: UV maps and weights stay."""

from collections.abc import Callable
from typing import Any

import bmesh
import numpy as np

from .. import core
from ..blender import Object
from ..errors import VERTEX_ON_EDGE
from ..mesh.write_filling import cut_sides
from .defects import elements_of


def repair(target: Object, defect: dict[str, Any]) -> None:
    """Mends a `defect` of check_object; `target` is in Edit Mode, and unchanged since."""
    bm = bmesh.from_edit_mesh(target.data)
    chosen = elements_of(bm, defect["kind"], defect["elements"])
    _REPAIRS[defect["code"]][1](bm, chosen)
    bmesh.update_edit_mesh(target.data)
    target.update_from_editmode()


def label(code: str) -> str | None:
    """The text of the button, or None if no command mends this."""
    return _REPAIRS[code][0] if code in _REPAIRS else None


def _flip(bm: bmesh.types.BMesh, faces: list[bmesh.types.BMFace]) -> None:
    # the faces that the core would reverse: the minority of each part
    bmesh.ops.reverse_faces(bm, faces=faces)


def _merge(bm: bmesh.types.BMesh, vertices: list[bmesh.types.BMVert]) -> None:
    bmesh.ops.remove_doubles(bm, verts=vertices, dist=_tiny(bm))


def _dissolve(bm: bmesh.types.BMesh, faces: list[bmesh.types.BMFace]) -> None:
    edges = list({edge for face in faces for edge in face.edges})
    bmesh.ops.dissolve_degenerate(bm, dist=_tiny(bm), edges=edges)


def _delete_loose(bm: bmesh.types.BMesh, vertices: list[bmesh.types.BMVert]) -> None:
    loose = [vertex for vertex in vertices if not vertex.link_faces]
    bmesh.ops.delete(bm, geom=loose, context="VERTS")


def _delete_duplicates(bm: bmesh.types.BMesh, faces: list[bmesh.types.BMFace]) -> None:
    seen, extra = set(), []
    for face in faces:
        key = frozenset(face.verts)
        (extra.append(face) if key in seen else seen.add(key))
    bmesh.ops.delete(bm, geom=extra, context="FACES_ONLY")


def _cut(bm: bmesh.types.BMesh, vertices: list[bmesh.types.BMVert]) -> None:
    """Cuts the border edge on which each vertex lies, so that both can be merged there."""
    for vertex in vertices:
        found = [
            (away, edge, share)
            for edge in bm.edges
            if edge.is_boundary and vertex not in edge.verts
            for away, share in [_away(vertex, edge)]
            if 0.0 < share < 1.0
        ]
        if found:
            begin, end = min(found, key=lambda one: one[0])[1].verts
            cut_sides(bm, [[begin, vertex, end]])


def _away(vertex: bmesh.types.BMVert, edge: bmesh.types.BMEdge) -> tuple[float, float]:
    """Distance from an edge's line, and the parameter along the edge, from 0 to 1."""
    begin, end = (v.co for v in edge.verts)
    way = end - begin
    share = float((vertex.co - begin) @ way) / (way.length_squared or 1.0)
    return float((vertex.co - begin - share * way).length), share


def _delete_surplus(bm: bmesh.types.BMesh, edges: list[bmesh.types.BMEdge]) -> None:
    """At edges with more than two faces, deletes the smaller sheets that end in a border."""
    faces = list(bm.faces)
    bm.verts.index_update()
    corners = np.array([v.index for face in faces for v in face.verts], np.int64)
    offsets = np.concatenate([[0], np.cumsum([len(face.verts) for face in faces])])
    steps = ("join", "normals", "inner", "pinched", "spikes", "folds", "fill")
    kept = core.module().clean(
        np.array([v.co for v in bm.verts], float),
        (corners, offsets.astype(np.int64)),
        islands=0.0,
        **dict.fromkeys(steps, False),
    )
    gone = np.ones(len(faces), bool)
    gone[kept.face_origin] = False
    parts = [faces[f] for f in np.flatnonzero(gone).tolist()]
    bmesh.ops.delete(bm, geom=parts, context="FACES")


def _tiny(bm: bmesh.types.BMesh) -> float:
    """An invisible distance: a millionth of the mesh's size."""
    points: list[Any] = [v.co for v in bm.verts if all(abs(x) < 1e30 for x in v.co[:])]
    if not points:
        return 1e-6
    return (
        1e-6 * max(max(p[i] for p in points) - min(p[i] for p in points) for i in range(3)) or 1e-6
    )


_REPAIRS: dict[str, tuple[str, Callable[[bmesh.types.BMesh, list[Any]], None]]] = {
    "INCONSISTENT_ORIENTATION": ("Flip Faces", _flip),
    "COINCIDENT_VERTICES": ("Merge by Distance", _merge),
    "REPEATED_VERTEX": ("Degenerate Dissolve", _dissolve),
    "DEGENERATE_FACE": ("Degenerate Dissolve", _dissolve),
    "ISOLATED_VERTICES": ("Delete Loose", _delete_loose),
    "DUPLICATE_FACE": ("Delete Extra Faces", _delete_duplicates),
    "NONMANIFOLD_EDGE": ("Delete Extra Faces", _delete_surplus),
    VERTEX_ON_EDGE: ("Cut Edges", _cut),
}
