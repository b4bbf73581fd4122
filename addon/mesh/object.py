# SPDX-License-Identifier: GPL-3.0-or-later
"""The new object beside its source: same transform, same collections, same materials."""

from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import contextmanager
from typing import Any, cast

import bpy

from ..blender import Context, Mesh, Object, all_objects

TURN = (
    "rotation_mode",  # first, since the others depend on it
    "rotation_euler",
    "rotation_quaternion",
    "rotation_axis_angle",
    "delta_rotation_euler",
    "delta_rotation_quaternion",
)
PLACE = (*TURN, "location", "delta_location", "scale", "delta_scale")
PARENT = ("parent", "parent_type", "parent_bone", "parent_vertices", "matrix_parent_inverse")


def session_key(block: bpy.types.ID) -> int:
    """A key of a data-block that stays valid through undo until its file is closed."""
    return block.session_uid


def changed_keys(depsgraph: bpy.types.Depsgraph, *, moved: bool) -> set[int]:
    """Keys of the data-blocks that an update has reshaped or, with `moved`, also moved."""
    return {
        session_key(cast(Any, update.id).original)
        for update in depsgraph.updates
        if update.is_updated_geometry or (moved and update.is_updated_transform)
    }


class Reference:
    """Finds its object again after undo and deletion, which invalidate pointers; None if it is gone."""

    def __init__(self, target: Object) -> None:
        self.key = session_key(target)
        self._name = target.name

    def find(self) -> Object | None:
        target = cast(Object | None, bpy.data.objects.get(self._name))
        if target is None or session_key(target) != self.key:
            target = next((o for o in all_objects() if session_key(o) == self.key), None)
        if target is not None:
            self._name = target.name
        return target


class Showing:
    """The mesh objects that viewports show something for, by `wanted`; found again when due."""

    def __init__(self, wanted: Callable[[Object], bool]) -> None:
        self._wanted = wanted
        self.references: list[Reference] | None = None
        self._count = 0

    def forget(self) -> None:
        self.references = None

    def __iter__(self) -> Iterator[Object]:
        count = len(bpy.data.objects)
        if self.references is None or count != self._count:
            self._count = count
            meshes = (o for o in all_objects() if o.type == "MESH")
            self.references = [Reference(o) for o in meshes if self._wanted(o)]
        found = [reference.find() for reference in self.references]
        return (target for target in found if target is not None)


def new_object(context: Context, source: Object, mesh: Mesh) -> Object:
    """Links a new object with `mesh` beside `source` and returns it. Does not change the source."""
    target = linked_object(context, mesh, source)
    copy_place(context, source, target)
    _copy_object_materials(source, target)
    return target


def new_surface(context: Context, source: Object, name: str) -> Object:
    """Links a new object beside `source`, with an empty mesh of the same materials, and returns it."""
    mesh = cast(Mesh, bpy.data.meshes.new(name))
    for material in source.data.materials:
        mesh.materials.append(material)
    return new_object(context, source, mesh)


def linked_object(context: Context, data: Any, source: Object | None = None) -> Object:
    """A new object with `data`, linked where its `source` is, or in the current collection."""
    target = cast(Object, bpy.data.objects.new(data.name, data))
    for collection in collections_for(context, source):
        collection.objects.link(target)
    return target


@contextmanager
def nothing_left_behind() -> Iterator[None]:
    """A context that removes new objects and meshes if an error ends it."""
    kinds: tuple[Any, ...] = (bpy.data.objects, bpy.data.meshes)
    before = [set(map(session_key, blocks)) for blocks in kinds]
    try:
        yield
    except BaseException:
        for blocks, known in zip(kinds, before):
            for block in [b for b in blocks if session_key(b) not in known]:
                blocks.remove(block)
        raise


def is_in_view_layer(context: Context, target: Object) -> bool:
    """Whether it can be selected and hidden: not excluded, nor only in another scene."""
    objects = context.view_layer.objects
    _ = objects.active  # makes Blender update the list
    return objects.get(target.name) == target


def why_not_here(context: Context, targets: Iterable[Object]) -> str:
    """Why some of the `targets` cannot be shown and selected, in one sentence; empty if they can."""
    away = next((one.name for one in targets if not is_in_view_layer(context, one)), "")
    return f"Link '{away}' to this scene first: it is not in this view layer" if away else ""


def select_only(context: Context, objects: list[Object]) -> None:
    """Selects exactly `objects`, the last one active; those outside the view layer stay."""
    here = [one for one in objects if is_in_view_layer(context, one)]
    if not here:
        return
    for other in context.view_layer.objects.selected[:]:
        other.select_set(False)
    for target in here:
        target.select_set(True)
    context.view_layer.objects.active = here[-1]


def collections_for(context: Context, source: Object | None = None) -> list[bpy.types.Collection]:
    """Collections for a new object: those of its `source`, unless linked or overridden."""
    beside = [] if source is None else source.users_collection
    for found in (beside, [context.collection], [context.scene.collection]):
        own = [each for each in found if not (each.library or each.override_library)]
        if own:
            return own
    return []


def copy_place(context: Context | None, source: Object, target: Object) -> None:
    """Gives `target` the transform and parent of `source`; no `context` within Blender's update."""
    if source.parent is not None or target.parent is not None:
        for name in PARENT:
            setattr(target, name, getattr(source, name))
    for name in PLACE:
        setattr(target, name, getattr(source, name))
    if source.constraints:  # the constraints are not copied, but their effect is
        if context is not None:
            context.view_layer.update()
        target.matrix_world = source.matrix_world


def _copy_object_materials(source: Object, target: Object) -> None:
    """Copies slots whose material is linked to the object instead of the mesh."""
    for own, theirs in zip(target.material_slots, source.material_slots):
        if theirs.link == "OBJECT":
            own.link = "OBJECT"
            own.material = theirs.material


def copy_drivers(
    source: Any, target: Any, prefix: str = "", leave_out: Collection[str] = ()
) -> None:
    """Copies the drivers of `source` with paths that begin with `prefix`, except `leave_out`."""
    if source.animation_data is None:
        return
    for driver in source.animation_data.drivers:
        path = driver.data_path
        if path.startswith(prefix) and path not in leave_out and _resolves(target, path):
            drivers = target.animation_data_create().drivers
            old = drivers.find(path, index=driver.array_index)
            if old is not None:
                drivers.remove(old)
            drivers.from_existing(src_driver=driver)


def _resolves(target: bpy.types.ID, path: str) -> bool:
    try:
        target.path_resolve(path)
    except ValueError:
        return False
    return True
