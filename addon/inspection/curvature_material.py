# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature colours as a node material: the colour attribute, a little darker where the surface turns away."""

import bpy

from .attributes import COLOUR
from .node_graph import TAG, Graph, lay_out, tagged

NAME = "Fairing Curvature"
MODE = "CURVATURE"


def curvature_material():
    """The one curvature material of the file, made if need be."""
    return tagged(bpy.data.materials, MODE) or _build()


def _build():
    material = bpy.data.materials.new(NAME)
    material[TAG] = MODE
    if not material.use_nodes:  # since 5.0 always on, and setting it is deprecated
        material.use_nodes = True
    graph = Graph(material.node_tree)
    colour = graph.node("ShaderNodeAttribute", attribute_name=COLOUR)
    geometry = graph.node("ShaderNodeNewGeometry")
    facing = graph.node(
        "ShaderNodeVectorMath",
        inputs={0: geometry.outputs["Incoming"], 1: geometry.outputs["Normal"]},
        operation="DOT_PRODUCT",
    )
    # enough shade to see the shape, too little to change what the colour says; no lamp is needed
    shade = graph.node(
        "ShaderNodeMapRange", "Shade", {"Value": facing.outputs["Value"], "To Min": 0.45, "To Max": 1.0}
    )
    emission = graph.node(
        "ShaderNodeEmission", inputs={"Color": colour.outputs["Color"], "Strength": shade.outputs["Result"]}
    )
    grey = graph.node(
        "ShaderNodeBsdfDiffuse"
    )  # what other objects see: the colours shall not light the scene
    seen = graph.node("ShaderNodeLightPath")
    mix = graph.node(
        "ShaderNodeMixShader",
        inputs={0: seen.outputs["Is Camera Ray"], 1: grey.outputs[0], 2: emission.outputs[0]},
    )
    graph.node("ShaderNodeOutputMaterial", inputs={"Surface": mix.outputs[0]})
    lay_out(material.node_tree)
    return material
