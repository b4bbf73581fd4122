# SPDX-License-Identifier: GPL-3.0-or-later
"""Zebra stripes as a node material: the surface as a mirror in a room of light tubes.

The tubes are rings at equal angles about one direction. They turn with the view, or stand still about the object.
"""

from math import cos, sin

import bpy

from .node_graph import TAG, Graph, lay_out, tagged

NAME = "Fairing Zebra"
LIGHT, DARK = (0.88, 0.88, 0.865, 1.0), (0.012, 0.013, 0.016, 1.0)


def zebra_material(settings):
    """The one zebra material of the file, made if need be and set as `settings` says."""
    material = tagged(bpy.data.materials, "ZEBRA") or _build()
    update(settings)
    return material


def update(settings):
    """Gives the material, if there is one, the values of `settings`: stripes, direction, sharpness, fixed_to."""
    material = tagged(bpy.data.materials, "ZEBRA")
    if material is None:
        return
    nodes = material.node_tree.nodes
    by_view = settings.fixed_to == "VIEW"
    # upright is y for the view and z for the object
    a = settings.direction
    nodes["Direction"].inputs[1].default_value = (sin(a), cos(a), 0.0) if by_view else (sin(a), 0.0, cos(a))
    nodes["Room"].convert_to = "CAMERA" if by_view else "OBJECT"
    nodes["Stripes"].inputs[1].default_value = 2.0 * settings.stripes
    width = 0.02 + (1.0 - settings.sharpness) * 0.98
    nodes["Edge"].inputs["From Min"].default_value = -width
    nodes["Edge"].inputs["From Max"].default_value = width


def _build():
    material = bpy.data.materials.new(NAME)
    material[TAG] = "ZEBRA"
    if not material.use_nodes:  # since 5.0 always on, and setting it is deprecated
        material.use_nodes = True
    graph = Graph(material.node_tree)

    geometry = graph.node("ShaderNodeNewGeometry")
    to_surface = graph.node(
        "ShaderNodeVectorMath", inputs={0: geometry.outputs["Incoming"], "Scale": -1.0}, operation="SCALE"
    )
    mirrored = graph.node(
        "ShaderNodeVectorMath",
        inputs={0: to_surface.outputs[0], 1: geometry.outputs["Normal"]},
        operation="REFLECT",
    )
    room = graph.node(
        "ShaderNodeVectorTransform",
        "Room",
        {0: mirrored.outputs[0]},
        vector_type="VECTOR",
        convert_from="WORLD",
    )
    # the object's scale would stretch the vector
    even = graph.node("ShaderNodeVectorMath", inputs={0: room.outputs[0]}, operation="NORMALIZE")
    along = graph.node("ShaderNodeVectorMath", "Direction", {0: even.outputs[0]}, operation="DOT_PRODUCT")
    angle = graph.math("ARCSINE", along.outputs["Value"])
    wave = graph.math("SINE", graph.math("MULTIPLY", angle, 2.0, name="Stripes"))
    edge = graph.node("ShaderNodeMapRange", "Edge", {"Value": wave}, interpolation_type="SMOOTHSTEP")
    stripes = graph.node("ShaderNodeMix", data_type="RGBA", blend_type="MIX")
    _set_colours(graph, stripes, edge.outputs["Result"])
    output = next(s for s in stripes.outputs if s.type == "RGBA")

    emission = graph.node("ShaderNodeEmission", inputs={"Color": output})
    grey = graph.node("ShaderNodeBsdfDiffuse")  # what other objects see: stripes shall not light the scene
    seen = graph.node("ShaderNodeLightPath")
    mix = graph.node(
        "ShaderNodeMixShader",
        inputs={0: seen.outputs["Is Camera Ray"], 1: grey.outputs[0], 2: emission.outputs[0]},
    )
    graph.node("ShaderNodeOutputMaterial", inputs={"Surface": mix.outputs[0]})
    lay_out(material.node_tree)
    return material


def _set_colours(graph, mix, factor):
    """The Mix node has sockets of the same name for every type: find those for colours."""
    colours = [socket for socket in mix.inputs if socket.type == "RGBA"]
    colours[0].default_value, colours[1].default_value = DARK, LIGHT
    graph.tree.links.new(factor, mix.inputs[0])
