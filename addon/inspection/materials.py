# SPDX-License-Identifier: GPL-3.0-or-later
"""Node materials for stripes and for colours of values, which an object shows without a change of its own: a
geometry-nodes modifier sets one material at the end.

Exchanging material slots would require restoring the slots of object and mesh, and of other objects with the same mesh,
through undo, saving, and a recompute that brings a new mesh. The modifier is plain Blender data: it shows the material
without the add-on, and can simply be deleted.
"""

from math import cos, pi, sin
from typing import Any

import bpy

from ..blender import Object, all_scenes
from ..mesh.modifiers import INSPECTION_TAG, inspection_modifier

# the key of the scene whose settings it has; none: that of the first scene, 0
SCENE_TAG = "fairing_inspection_scene"

# the colour attribute that the curvature material reads
COLOUR = "Fairing Curvature"

# modes of inspection that show stripes, and their materials
STRIPES = {
    "ZEBRA": "Fairing Zebra",
    "LINES": "Fairing Reflection Lines",
    "ISOPHOTES": "Fairing Isophotes",
}
_LIGHT, _DARK = (0.88, 0.88, 0.865), (0.012, 0.013, 0.016)  # linear
_LINE = 0.15  # relative to the distance between two reflection lines: their thickness
CURVATURE_NAME, CURVATURE_MODE = "Fairing Curvature", "CURVATURE"


class Graph:
    """Adds nodes to a tree; inputs are sockets to link or plain values."""

    def __init__(self, tree: Any) -> None:
        self.tree = tree
        tree.nodes.clear()

    def node(self, kind: str, name: str = "", inputs: Any = (), **settings: Any) -> Any:
        """A node with the properties `settings` and the `inputs`: a dict by socket name or position."""
        node = self.tree.nodes.new(kind)
        if name:
            node.name = node.label = name
        for key, value in settings.items():
            setattr(node, key, value)
        for key, value in dict(inputs).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node

    def math(self, operation: str, first: Any, second: Any = 0.0, name: str = "") -> Any:
        return self.node(
            "ShaderNodeMath", name, {0: first, 1: second}, operation=operation
        ).outputs[0]


def scene_key(settings: Any) -> int:
    """A number that identifies the scene of `settings`; new and copied scenes get their own."""
    others = {
        scene.discrete_fairing_inspection.key
        for scene in all_scenes()
        if scene != settings.id_data and scene.library is None
    }
    if settings.key in others:
        settings.key = max(others) + 1
    return settings.key


def tagged(collection: Any, mode: str, key: int = 0) -> Any:
    """The member of a bpy.data collection that was made for `mode` in the scene with `key`, or None."""
    return next(
        (
            item
            for item in collection
            if item.get(INSPECTION_TAG) == mode
            and item.get(SCENE_TAG, 0) == key
            and item.library is None
        ),
        None,
    )


def tag(item: Any, mode: str, key: int) -> None:
    """Marks a material or node group for `tagged`."""
    item[INSPECTION_TAG] = mode
    if key:
        item[SCENE_TAG] = key


def stripes_material(mode: str, settings: Any) -> bpy.types.Material:
    """The material for one of STRIPES in the scene with these `settings`; created if missing.

    Each point has a direction: that of the mirrored ray, or for isophotes that of the normal. A wave of its
    angle from the plane across the axis of the room is dark where it is low.
    """
    key = scene_key(settings)
    material: Any = tagged(bpy.data.materials, mode, key) or _build_stripes(mode, key)
    nodes, by_view = material.node_tree.nodes, settings.fixed_to == "VIEW"
    along, up = sin(settings.direction), cos(settings.direction)
    # upright is y in the view and z in the object
    nodes["Direction"].inputs[1].default_value = (along, up, 0.0) if by_view else (along, 0.0, up)
    nodes["Room"].convert_to = "CAMERA" if by_view else "OBJECT"
    nodes["Stripes"].inputs[1].default_value = 2.0 * settings.stripes
    level = -cos(pi * _LINE) if mode == "LINES" else 0.0  # of the wave, dark below
    width = 0.02 + (1.0 - settings.sharpness) * 0.98  # half of the transition's
    nodes["Edge"].inputs["From Min"].default_value = level - width
    nodes["Edge"].inputs["From Max"].default_value = level + width
    return material


def _begin(name: str, mode: str, key: int = 0) -> tuple[bpy.types.Material, Graph]:
    """A new material for a mode of inspection, and its empty graph."""
    material = bpy.data.materials.new(name)
    tag(material, mode, key)
    if not material.use_nodes:  # always on since 5.0, where setting it is deprecated
        material.use_nodes = True
    return material, Graph(material.node_tree)


def _finish(graph: Graph, emission: bpy.types.Node) -> None:
    """Emission towards the camera; for other rays grey, so that it does not light the scene."""
    grey = graph.node("ShaderNodeBsdfDiffuse")
    seen = graph.node("ShaderNodeLightPath")
    mix = graph.node(
        "ShaderNodeMixShader",
        inputs={0: seen.outputs["Is Camera Ray"], 1: grey.outputs[0], 2: emission.outputs[0]},
    )
    graph.node("ShaderNodeOutputMaterial", inputs={"Surface": mix.outputs[0]})


def _seen_direction(graph: Graph, mode: str) -> bpy.types.NodeSocket:
    """The direction of the mirrored ray, or for isophotes that of the normal."""
    geometry = graph.node("ShaderNodeNewGeometry")
    if mode == "ISOPHOTES":
        return geometry.outputs["Normal"]
    to_surface = graph.node(
        "ShaderNodeVectorMath",
        inputs={0: geometry.outputs["Incoming"], "Scale": -1.0},
        operation="SCALE",
    )
    mirrored = graph.node(
        "ShaderNodeVectorMath",
        inputs={0: to_surface.outputs[0], 1: geometry.outputs["Normal"]},
        operation="REFLECT",
    )
    return mirrored.outputs[0]


def _build_stripes(mode: str, key: int) -> bpy.types.Material:
    material, graph = _begin(STRIPES[mode], mode, key)
    room = graph.node(
        "ShaderNodeVectorTransform",
        "Room",
        {0: _seen_direction(graph, mode)},
        vector_type="VECTOR",
        convert_from="WORLD",
    )
    # the object's scale would stretch the vector
    even = graph.node("ShaderNodeVectorMath", inputs={0: room.outputs[0]}, operation="NORMALIZE")
    along = graph.node(
        "ShaderNodeVectorMath", "Direction", {0: even.outputs[0]}, operation="DOT_PRODUCT"
    )
    angle = graph.math("ARCSINE", along.outputs["Value"])
    wave = graph.math("SINE", graph.math("MULTIPLY", angle, 2.0, name="Stripes"))
    edge = graph.node(
        "ShaderNodeMapRange", "Edge", {"Value": wave}, interpolation_type="SMOOTHSTEP"
    )
    stripes = graph.node("ShaderNodeMix", data_type="RGBA", blend_type="MIX")
    _set_colours(graph, stripes, edge.outputs["Result"])
    output = next(s for s in stripes.outputs if s.type == "RGBA")

    emission = graph.node("ShaderNodeEmission", inputs={"Color": output})
    _finish(graph, emission)
    return material


def _set_colours(graph: Graph, mix: Any, factor: bpy.types.NodeSocket) -> None:
    """Sets the colour sockets of the Mix node, which has sockets of the same name for every type."""
    colours = [socket for socket in mix.inputs if socket.type == "RGBA"]
    colours[0].default_value, colours[1].default_value = (*_DARK, 1.0), (*_LIGHT, 1.0)
    graph.tree.links.new(factor, mix.inputs[0])


def curvature_material() -> bpy.types.Material:
    """The single curvature material of the file; created if missing."""
    return tagged(bpy.data.materials, CURVATURE_MODE) or _build_curvature()


def _build_curvature() -> bpy.types.Material:
    material, graph = _begin(CURVATURE_NAME, CURVATURE_MODE)
    colour = graph.node("ShaderNodeAttribute", attribute_name=COLOUR)
    geometry = graph.node("ShaderNodeNewGeometry")
    facing = graph.node(
        "ShaderNodeVectorMath",
        inputs={0: geometry.outputs["Incoming"], 1: geometry.outputs["Normal"]},
        operation="DOT_PRODUCT",
    )
    # enough shade to show the shape, but too little to change the colours; needs no lamp
    shade = graph.node(
        "ShaderNodeMapRange",
        "Shade",
        {"Value": facing.outputs["Value"], "To Min": 0.45, "To Max": 1.0},
    )
    emission = graph.node(
        "ShaderNodeEmission",
        inputs={"Color": colour.outputs["Color"], "Strength": shade.outputs["Result"]},
    )
    _finish(graph, emission)
    return material


MODIFIER_NAME = "Fairing Inspection"


def put_on(target: Object, mode: str, material: bpy.types.Material, settings: Any) -> None:
    """Shows `target` in `material`, smooth by the scene's `settings`; one node group a `mode`."""
    modifier: Any = inspection_modifier(target) or target.modifiers.new(MODIFIER_NAME, "NODES")
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
    tree: Any = bpy.data.node_groups.new(f"{MODIFIER_NAME} {mode.title()}", "GeometryNodeTree")
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
