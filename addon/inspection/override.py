# SPDX-License-Identifier: GPL-3.0-or-later
"""An object in another material, without a hand on its own: a geometry-nodes modifier that sets one material at the end.

Swapping the material slots instead would have to put back slots of object and mesh, also of other objects with the same
mesh, through undo, saving, and a recompute that brings a new mesh. The modifier is plain Blender data: without the add-on
it still shows the material, and deleting it ends the matter.
"""

from contextlib import contextmanager

import bpy

from .node_graph import TAG, Graph, lay_out, tagged

NAME = "Fairing Inspection"


def put_on(target, mode, material, smooth):
    """Shows `target` in `material`, shaded smooth if asked. `mode` names what is shown, one node group for each."""
    modifier = find(target) or target.modifiers.new(NAME, "NODES")
    modifier.node_group = _group(mode, material, smooth)
    modifier.show_expanded = False
    modifier.show_viewport = modifier.show_render = True


def take_off(target):
    """Removes the override, and what it needed if nobody else does."""
    modifier = find(target)
    if modifier is not None:
        target.modifiers.remove(modifier)
    for collection in (bpy.data.node_groups, bpy.data.materials):
        for item in [i for i in collection if TAG in i and i.library is None and not i.users]:
            collection.remove(item)


def find(target):
    """The modifier that overrides the material of `target`, or None."""
    return next(
        (
            m
            for m in target.modifiers
            if m.type == "NODES" and m.node_group is not None and TAG in m.node_group
        ),
        None,
    )


def set_smooth(tree, smooth):
    tree.nodes["Smooth"].mute = not smooth


@contextmanager
def suspended(context, *targets):
    """Inside the `with` the evaluated meshes of `targets` are what they are without inspection, for reading or export."""
    shown = [m for m in map(find, targets) if m is not None and (m.show_viewport or m.show_render)]
    before = [(m.show_viewport, m.show_render) for m in shown]
    for modifier in shown:
        modifier.show_viewport = modifier.show_render = False
    if shown:
        context.view_layer.update()
    try:
        yield
    finally:
        for modifier, (viewport, render) in zip(shown, before, strict=True):
            modifier.show_viewport, modifier.show_render = viewport, render


def _group(mode, material, smooth):
    tree = tagged(bpy.data.node_groups, mode) or _build(mode)
    tree.nodes["Material"].inputs["Material"].default_value = material
    set_smooth(tree, smooth)
    return tree


def _build(mode):
    tree = bpy.data.node_groups.new(f"{NAME} {mode.title()}", "GeometryNodeTree")
    tree[TAG] = mode
    tree.is_modifier = True
    for in_out in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    graph = Graph(tree)
    start = graph.node("NodeGroupInput")
    smooth = graph.node("GeometryNodeSetShadeSmooth", "Smooth", {"Geometry": start.outputs[0]})
    material = graph.node("GeometryNodeSetMaterial", "Material", {"Geometry": smooth.outputs[0]})
    graph.node("NodeGroupOutput", inputs={0: material.outputs[0]})
    lay_out(tree)
    return tree
