# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads control meshes: the objects to fair, and their present meshes as arrays."""

from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from typing import Any, cast

import bpy
import numpy as np

from .. import vertex_values
from ..blender import Context, Mesh, Object, column
from ..core import ControlArrays
from ..errors import JobError
from ..memory import source_of
from ..settings import AnySettings, is_near
from .layers import STORAGE, values_of_layer
from .marks import BOUNDARY, FLAT, NORMAL
from .marks import read as read_marked


def source_objects(context: Context) -> list[Object]:
    """The meshes to fair: selected, or edited in Edit Mode; the active one if there are none."""
    active = context.active_object
    if context.mode == "EDIT_MESH":
        return list(context.objects_in_mode_unique_data)
    selected = [o for o in context.selected_objects if o.type == "MESH"]
    if not selected and active is not None and active.type == "MESH":
        selected = [active]
    # the active one last, so that its result becomes active
    return sorted(selected, key=lambda o: o == active)


def control_meshes(context: Context) -> list[Object]:
    """The source_objects without faired surfaces, which Recompute makes again; these too if there are no
    others.
    """
    chosen = source_objects(context)
    return [target for target in chosen if source_of(target) is None] or chosen


def active_mesh(context: Context) -> list[Object]:
    """The active object alone; empty if it is not a mesh."""
    active = context.active_object
    return [active] if active is not None and active.type == "MESH" else []


@contextmanager
def control_mesh(
    context: Context,
    source: Object,
    evaluated: bool = False,
    depsgraph: bpy.types.Depsgraph | None = None,
) -> Iterator[Mesh]:
    """The bpy.types.Mesh to read, with present edits; valid inside the `with` only.

    `evaluated`: with the modifiers of `source` applied, as in `depsgraph`; None: updated first.
    """
    if source.mode == "EDIT":
        source.update_from_editmode()
    if evaluated:
        known = (
            nullcontext(_of_update(source, depsgraph)) if depsgraph else _evaluated(context, source)
        )
        with known as owner, _copy_of_mesh(owner) as mesh:
            yield mesh
    elif (
        source.mode == "EDIT"
    ):  # then it lists the attributes of the edit, not its own, so a copy is read
        with _copy_of_mesh(source) as mesh:
            yield mesh
    else:
        yield source.data


@contextmanager
def _copy_of_mesh(owner: Object) -> Iterator[Mesh]:
    try:
        yield cast(Mesh, owner.to_mesh())
    finally:
        owner.to_mesh_clear()


@contextmanager
def _evaluated(context: Context, source: Object) -> Iterator[Object]:
    """`source` with its modifiers applied.

    Blender does not evaluate objects that are hidden, disabled, excluded or not in the scene, so a
    temporary copy is evaluated.
    """
    if source.visible_get():
        yield source.evaluated_get(context.evaluated_depsgraph_get())
        return
    shown = source.copy()
    try:
        shown.hide_viewport = False
        context.scene.collection.objects.link(shown)
        yield shown.evaluated_get(context.evaluated_depsgraph_get())
    finally:
        bpy.data.objects.remove(shown)


def _of_update(source: Object, depsgraph: bpy.types.Depsgraph) -> Object:
    """`source` in `depsgraph`, with its modifiers applied; JobError if it is missing there."""
    if not source.visible_get(view_layer=depsgraph.view_layer):
        raise JobError(
            f"{source.name}: Show it, or set Control Mesh to As Modelled. It is hidden, so Blender "
            "does not run its modifiers."
        )
    return source.evaluated_get(depsgraph)


def read_mesh(mesh: Mesh) -> ControlArrays:
    """`mesh` (bpy.types.Mesh, not in Edit Mode) as ControlArrays."""
    vertices, edges, corners = len(mesh.vertices), len(mesh.edges), len(mesh.loops)
    return ControlArrays(
        positions=_required(mesh, "position", "POINT", "FLOAT_VECTOR", vertices)
        .reshape(-1, 3)
        .astype(np.float64),
        edges=_required(mesh, ".edge_verts", "EDGE", "INT32_2D", edges).reshape(-1, 2),
        corners=_required(mesh, ".corner_vert", "CORNER", "INT", corners),
        corner_edges=_required(mesh, ".corner_edge", "CORNER", "INT", corners),
        offsets=np.append(column(mesh.polygons, "loop_start", np.int32), np.int32(corners)),
        edge_crease=values_of_layer(mesh, "crease_edge", "FLOAT", "EDGE"),
        vertex_crease=values_of_layer(mesh, "crease_vert", "FLOAT", "POINT"),
        sharp_edge=values_of_layer(mesh, "sharp_edge", "BOOLEAN", "EDGE"),
        boundary_edge=read_marked(mesh, BOUNDARY),
        normals=read_marked(mesh, NORMAL),
        flat_face=read_marked(mesh, FLAT),
    )


def _required(mesh: Mesh, name: str, domain: str, data_type: str, size: int) -> np.ndarray:
    """An attribute that every mesh has, but that is not listed if empty."""
    values = values_of_layer(mesh, name, data_type, domain)
    if values is None and size:
        raise RuntimeError(
            f"The mesh '{mesh.name}' has no attribute '{name}' ({data_type} on {domain})"
        )
    return np.empty(0, STORAGE[data_type].dtype) if values is None else values


def shown_selection(elements: Any) -> np.ndarray:
    """(k,) bool: the `elements`, vertices or faces of a mesh, that are selected and visible."""
    return column(elements, "select", bool) & ~column(elements, "hide", bool)


def selected_faces(mesh: Mesh, source_name: str) -> np.ndarray:
    """(r,) int32: ids of the selected and visible faces; JobError without any."""
    found = np.flatnonzero(shown_selection(mesh.polygons)).astype(np.int32)
    if not len(found):
        raise JobError(
            f"{source_name}: Select the faces to fair in Edit Mode, or switch off Selected Faces Only. "
            "No face is selected."
        )
    return found


def group_values(source: Object, mesh: Mesh, settings: AnySettings) -> dict[str, np.ndarray]:
    """Arguments of `core.fair_arguments` (n,) from vertex groups; JobError if a group is missing."""
    readers = {
        "tolerance_factors": (vertex_values.factors, settings.tolerance_group),
        "pulls": (vertex_values.pulls, settings.pull_group),
    }
    named = readers.items() if is_near(settings) else ()
    return {name: read(source, mesh, group) for name, (read, group) in named if group}
