# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of a check: defects, and holes with their widths and places; stored with the object, and selected in Edit
Mode.
"""

from collections.abc import Sequence
from typing import Any

import bmesh
import bpy

from .. import core, memory
from ..blender import Context, Mesh, Object
from ..mesh import mesh_changes
from ..mesh.read import control_mesh, read_mesh
from ..mesh.world_shape import WorldShape, world_shape
from ..transfer.hole_loops import holes_in, sides_of

_RANK = {"vertex": 0, "edge": 1, "face": 2}


def check_object(context: Context, target: Object) -> list[dict[str, Any]]:
    """Checks the mesh of `target`, in any mode; stores defects and holes, returns the defects."""
    with control_mesh(context, target) as mesh:
        arrays = read_mesh(mesh)
    found = core.module().check(arrays.positions, (arrays.corners, arrays.offsets))
    defects = as_dicts(found)
    store_defects(context, target, defects, listed_holes(arrays, world_shape(target)))
    return defects


def entry(
    code: str, kind: str, elements: Sequence[Any], severity: str = "warning", message: str = ""
) -> dict[str, Any]:
    """A defect as plain data, which can be stored."""
    plain = [list(e) if isinstance(e, tuple) else int(e) for e in elements]
    found = {"code": code, "message": message, "kind": kind, "elements": plain}
    return found | {"severity": severity}


def as_dicts(found: Sequence[Any]) -> list[dict[str, Any]]:
    return [entry(d.code, d.kind, d.elements, d.severity, d.message) for d in found]


def store_defects(
    context: Context,
    target: Object,
    defects: list[dict[str, Any]],
    holes: list[dict[str, Any]] | None = None,
    cleaned: Sequence[str] = (),
) -> None:
    """Stores the result of a check, or of Clean Scan (`cleaned`). `holes`: None keeps the known ones."""
    if holes is None:
        holes, cleaned = recall_holes(target), recall_cleaned(target)
    counts = mesh_changes.watch(context, target.data)
    record = {"defects": defects, "holes": holes, "cleaned": list(cleaned), "counts": counts}
    memory.keep(target, "defects", record)


def recall_holes(target: Object) -> list[dict[str, Any]]:
    """The holes of the last check: `width`, the number of `edges`, and one edge, `at`."""
    return (memory.recall(target, "defects") or {"holes": []})["holes"]


def recall_cleaned(target: Object) -> list[str]:
    """Sentences on what Clean Scan has done since the last check."""
    return (memory.recall(target, "defects") or {"cleaned": []})["cleaned"]


def recall_defects(target: Object) -> tuple[list[dict[str, Any]], bool] | None:
    """(defects, whether the mesh was changed since), or None if it was never checked."""
    record = memory.recall(target, "defects")
    if record is None:
        return None
    return record["defects"], mesh_changes.is_stale(target.data, record["counts"])


def enter_edit_mode(context: Context, targets: list[Object]) -> None:
    """Puts exactly `targets` into Edit Mode, the last active; RuntimeError if Blender refuses."""
    if context.mode == "EDIT_MESH" and all(t.mode == "EDIT" for t in targets):
        context.view_layer.objects.active = targets[-1]
        return
    if context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for other in context.view_layer.objects.selected[:]:
        other.select_set(False)
    for target in targets:
        target.hide_set(False)
        target.select_set(True)
    context.view_layer.objects.active = targets[-1]
    bpy.ops.object.mode_set(mode="EDIT")


def select_defects(context: Context, target: Object, kind: str, elements: Sequence[Any]) -> int:
    """Enters Edit Mode on `target` and selects exactly `elements`, unhidden, in the select mode of
    their `kind`.

    `kind`: "vertex", "edge" (elements are vertex pairs), "face" or "mesh", for which nothing can be
    selected. Returns the number of selected elements.
    """
    return select_in_all(context, [(target, [(kind, elements)])])


def select_in_all(
    context: Context, wanted: list[tuple[Object, list[tuple[str, Sequence[Any]]]]]
) -> int:
    """The same for several objects: `wanted` has (object, [(kind, elements), …]) pairs.

    The first kind determines the select mode, in which elements of lower kinds cannot be selected, and
    of higher kinds all parts are.
    """
    targets = [target for target, _ in wanted]
    enter_edit_mode(context, targets)
    first = next((kind for _, groups in wanted for kind, _ in groups if kind in _RANK), "vertex")
    context.tool_settings.mesh_select_mode = [_RANK[first] == rank for rank in range(3)]
    bpy.ops.mesh.select_all(action="DESELECT")
    return sum(_select(target.data, groups, _RANK[first]) for target, groups in wanted)


def bring_into_view(context: Context) -> None:
    """The context with a viewport as its area, for operators that select."""
    if context.area is not None and context.area.type == "VIEW_3D":
        bpy.ops.view3d.view_selected()


def elements_of(bm: bmesh.types.BMesh, kind: str, elements: Sequence[Any]) -> list[Any]:
    """BMesh elements for ids of the core, without deleted ones."""
    vertices, faces = bm.verts, bm.faces
    vertices.ensure_lookup_table()
    faces.ensure_lookup_table()
    if kind == "vertex":
        return [vertices[i] for i in elements if i < len(vertices)]
    if kind == "face":
        return [faces[i] for i in elements if i < len(faces)]
    if kind == "edge":
        pairs = (
            (vertices[a], vertices[b]) for a, b in elements if a != b and max(a, b) < len(vertices)
        )
        return [edge for edge in map(bm.edges.get, pairs) if edge is not None]
    return []


def _select(mesh: Mesh, groups: list[tuple[str, Sequence[Any]]], rank: int) -> int:
    bm = bmesh.from_edit_mesh(mesh)
    chosen = [
        e for kind, ids in groups if _RANK.get(kind, -1) >= rank for e in elements_of(bm, kind, ids)
    ]
    for element in chosen:
        element.hide_set(False)
        element.select_set(True)
    bm.select_flush_mode()
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    return len(chosen)


MOST_HOLES = 50  # the widest holes, which are kept; longer lists are of no use


def loops_of(arrays: core.ControlArrays) -> list[list[int]]:
    """The border loops of a mesh; none if the core refuses the mesh."""
    if not (arrays.edge_uses == 1).any():
        return []
    try:
        holes = holes_in(arrays.positions, (arrays.corners, arrays.offsets))
    except core.module().FairingError:
        return []
    return [loop for hole in holes for loop in hole]


def listed_holes(arrays: core.ControlArrays, shape: WorldShape) -> list[dict[str, Any]]:
    """For each hole its `width`, the widest first, its number of `edges`, and one of them, `at`."""
    points, width_of = shape.of(arrays.positions), core.module().hole_width
    holes = [
        {"width": width_of(points[loop]), "edges": len(loop), "at": loop[:2]}
        for loop in loops_of(arrays)
    ]
    return sorted(holes, key=lambda hole: -hole["width"])[:MOST_HOLES]


def edges_of(context: Context, target: Object, at: list[int]) -> list[list[int]]:
    """The edges of the hole with the edge `at`, as pairs of vertices; none if it no longer exists."""
    with control_mesh(context, target) as mesh:
        arrays = read_mesh(mesh)
    side = frozenset(at)
    found = next((loop for loop in loops_of(arrays) if side in sides_of(loop)), None)
    return [] if found is None else [list(pair) for pair in sides_of(found)]
