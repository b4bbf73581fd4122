# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows an object in another material without changing its own: a geometry-nodes modifier sets one
material at the end.

Exchanging material slots would require restoring the slots of object and mesh, and of other objects
with the same mesh, through undo, saving, and a recompute that brings a new mesh. The modifier is plain
Blender data: it shows the material without the add-on, and can simply be deleted.
"""

from typing import Any

import bpy

from ..blender import Object
from ..mesh.modifiers import INSPECTION_TAG, inspection_modifier
from .materials import Graph, scene_key, tag, tagged

NAME = "Fairing Inspection"


def put_on(target: Object, mode: str, material: bpy.types.Material, settings: Any) -> None:
    """Shows `target` in `material`, smooth by the scene's `settings`; one node group a `mode`."""
    modifier: Any = inspection_modifier(target) or target.modifiers.new(NAME, "NODES")
    modifier.node_group = _group(mode, material, settings)
    modifier.show_expanded = False
    modifier.show_viewport = modifier.show_render = True


def take_off(target: Object) -> None:
    """Shows `target` in its own materials again, and removes unused data."""
    modifier = inspection_modifier(target)
    if modifier is not None:
        target.modifiers.remove(modifier)
    collections: tuple[Any, ...] = (bpy.data.node_groups, bpy.data.materials)
    for collection in collections:
        for item in [
            i for i in collection if INSPECTION_TAG in i and i.library is None and not i.users
        ]:
            collection.remove(item)


def _group(mode: str, material: bpy.types.Material, settings: Any) -> bpy.types.NodeTree:
    key = scene_key(settings)
    tree: Any = tagged(bpy.data.node_groups, mode, key) or _build(mode, key)
    tree.nodes["Material"].inputs["Material"].default_value = material
    tree.nodes["Smooth"].mute = not settings.smooth
    return tree


def _build(mode: str, key: int) -> bpy.types.NodeTree:
    tree: Any = bpy.data.node_groups.new(f"{NAME} {mode.title()}", "GeometryNodeTree")
    tag(tree, mode, key)
    tree.is_modifier = True
    for in_out in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    graph = Graph(tree)
    start = graph.node("NodeGroupInput")
    smooth = graph.node("GeometryNodeSetShadeSmooth", "Smooth", {"Geometry": start.outputs[0]})
    material = graph.node("GeometryNodeSetMaterial", "Material", {"Geometry": smooth.outputs[0]})
    graph.node("NodeGroupOutput", inputs={0: material.outputs[0]})
    return tree
