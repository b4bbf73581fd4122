# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's types with the add-on's properties, for annotations; and registration."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, TypeAlias, cast

import bpy
import numpy as np

Answer: TypeAlias = set[Any]  # returned by operators: {"FINISHED"} or {"CANCELLED"}

if TYPE_CHECKING:
    from .inspection.settings import FAIRING_PG_display, FAIRING_PG_inspection
    from .live.switch import FAIRING_PG_live
    from .memory import FAIRING_PG_fit, FAIRING_PG_mesh, FAIRING_PG_surface
    from .properties import FAIRING_PG_settings
    from .strain.settings import FAIRING_PG_strain, FAIRING_PG_strain_drawing
    from .surfaces.curve_cage import FAIRING_PG_curves

    class Mesh(bpy.types.Mesh):
        """A mesh with the properties stored beside its curvature colours."""

        attributes: Any  # each kind of attribute has values of its own type
        discrete_fairing: FAIRING_PG_mesh

    class Object(bpy.types.Object):
        """A mesh object; the add-on works on no others."""

        data: Mesh
        discrete_fairing: FAIRING_PG_surface
        discrete_fairing_curves: FAIRING_PG_curves
        discrete_fairing_live: FAIRING_PG_live
        discrete_fairing_inspection: FAIRING_PG_display
        discrete_fairing_strain: FAIRING_PG_strain
        discrete_fairing_fit: FAIRING_PG_fit

    class Scene(bpy.types.Scene):
        """A scene with the panel's settings."""

        objects: Any
        discrete_fairing: FAIRING_PG_settings
        discrete_fairing_inspection: FAIRING_PG_inspection
        discrete_fairing_strain: FAIRING_PG_strain_drawing

    class Context(bpy.types.Context):
        """A context with a scene, as in every open file."""

        scene: Scene
        collection: bpy.types.Collection
        preferences: bpy.types.Preferences
        view_layer: bpy.types.ViewLayer
        window_manager: bpy.types.WindowManager
        workspace: bpy.types.WorkSpace
        tool_settings: bpy.types.ToolSettings
        active_object: Object | None
        selected_objects: list[Object]  # type: ignore[assignment]
        objects_in_mode_unique_data: list[Object]  # type: ignore[assignment]

    OperatorBase = bpy.types.Operator
else:
    OperatorBase = object  # mixins are no operators, but use their attributes
    Mesh, Object, Scene = bpy.types.Mesh, bpy.types.Object, bpy.types.Scene
    Context = bpy.types.Context


def viewport_of(context: Context) -> tuple[Any, Any] | None:
    """The space and the view of the viewport that is being drawn; None elsewhere."""
    space, view = cast(Any, context.space_data), cast(Any, context.region_data)
    return None if space is None or space.type != "VIEW_3D" or view is None else (space, view)


def current_context() -> Context:
    """The context, for code that is not given one."""
    return cast(Context, bpy.context)


def all_objects() -> Iterable[Object]:
    """Every object of the file, of any type; check the type before the mesh."""
    return cast(Iterable[Object], bpy.data.objects)


def all_scenes() -> Iterable[Scene]:
    return cast(Iterable[Scene], bpy.data.scenes)


def scene_of(target: Object) -> Scene:
    """The current window's scene if it has `target`, else another one with it."""
    here, owners = current_context().scene, cast(Any, target).users_scene
    return here if here in owners or not owners else owners[0]


def column(elements: Any, name: str, dtype: Any = np.float32, width: int = 1) -> np.ndarray:
    """(k,) or (k, width): the property `name` of all mesh `elements`."""
    values = np.empty(len(elements) * width, dtype)
    elements.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values
