# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's types as the add-on meets them: with its properties, and what is always there."""

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, TypeAlias, cast

import bpy
import numpy as np
from bpy.props import PointerProperty

Answer: TypeAlias = set[Any]  # of an operator: {"FINISHED"} and the like

if TYPE_CHECKING:
    from .curve_cage import FAIRING_PG_curves
    from .inspection.settings import FAIRING_PG_display, FAIRING_PG_inspection
    from .live.switch import FAIRING_PG_live
    from .memory import FAIRING_PG_fit, FAIRING_PG_mesh, FAIRING_PG_surface
    from .properties import FAIRING_PG_settings
    from .strain.settings import FAIRING_PG_strain, FAIRING_PG_strain_drawing

    class Mesh(bpy.types.Mesh):
        """A mesh with what is kept beside its curvature colours."""

        attributes: Any  # each kind has its own type of values
        discrete_fairing: FAIRING_PG_mesh

    class Object(bpy.types.Object):
        """A mesh object: no other is ever worked on."""

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
        """A context with a scene, as in any file that is open."""

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
    OperatorBase = object  # mixins are no operators: they only rely on what operators have
    Mesh, Object, Scene = bpy.types.Mesh, bpy.types.Object, bpy.types.Scene
    Context = bpy.types.Context


def current_context() -> Context:
    """Where no context is handed over."""
    return cast(Context, bpy.context)


def all_objects() -> Iterable[Object]:
    """Every object of the file. Ask for its type before its mesh."""
    return cast(Iterable[Object], bpy.data.objects)


def all_scenes() -> Iterable[Scene]:
    """Every scene of the file."""
    return cast(Iterable[Scene], bpy.data.scenes)


def scene_of(target: Object) -> Scene:
    """The scene whose settings count for `target`: that of the current window if it has the object, else
    another one that has. Handlers and timers may be called with any window's.
    """
    here, owners = current_context().scene, cast(Any, target).users_scene
    return here if here in owners or not owners else owners[0]


def column(elements: Any, name: str, dtype: Any = np.float32, width: int = 1) -> np.ndarray:
    """(k,) or (k, width): the property `name` of all `elements` of a mesh."""
    values = np.empty(len(elements) * width, dtype)
    elements.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values


Registration: TypeAlias = tuple[Callable[[], None], Callable[[], None]]  # register, unregister


def registration(*classes: type) -> Registration:
    """Of `classes`."""
    factory: Any = bpy.utils.register_classes_factory  # whose stub says None
    register, unregister = factory(classes)
    return register, unregister


def attached(*groups: tuple[type, str, type]) -> Registration:
    """Of property groups (owner, name, group): all data-blocks of the type `owner` get one by that name."""
    make_property: Any = PointerProperty  # whose stub says None

    def register() -> None:
        for owner, name, group in groups:
            bpy.utils.register_class(group)
            setattr(owner, name, make_property(type=group))

    def unregister() -> None:
        for owner, name, group in reversed(groups):
            delattr(owner, name)
            bpy.utils.unregister_class(group)

    return register, unregister


def in_order(*parts: Registration) -> Registration:
    """Of all of them, taken back from the last to the first."""

    def register() -> None:
        for begin, _ in parts:
            begin()

    def unregister() -> None:
        for _, end in reversed(parts):
            end()

    return register, unregister
