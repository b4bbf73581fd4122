# SPDX-License-Identifier: GPL-3.0-or-later
"""Zebra stripes: the surface is a mirror in a room of light tubes that moves with the view. A broken stripe
shows a fold, a kinked stripe a jump of curvature; on a fair surface stripes run evenly.
"""

import bpy
from render_studio import dress

TILT = 0.30  # radians: leaning tubes say more than level ones
LIGHT, DARK = (0.88, 0.88, 0.865), (0.012, 0.013, 0.016)


def dress_in_zebra(*targets, stripes):
    """`stripes`: pairs of light and dark from the lowest reflection to the highest."""
    material = _zebra(stripes)
    for target in targets:
        dress(target, material)


def _zebra(stripes):
    material = bpy.data.materials.new("Zebra")
    material.use_nodes = True
    graph = _Graph(material.node_tree)

    geometry = graph.node("ShaderNodeNewGeometry")
    to_eye = graph.vector("SCALE", geometry.outputs["Incoming"], scale=-1.0)
    mirrored = graph.vector("REFLECT", to_eye, geometry.outputs["Normal"])
    to_view = graph.node("ShaderNodeVectorTransform")
    to_view.vector_type, to_view.convert_from, to_view.convert_to = "VECTOR", "WORLD", "CAMERA"
    graph.link(mirrored, to_view.inputs[0])
    turned = graph.node("ShaderNodeVectorRotate")
    turned.rotation_type = "Z_AXIS"
    turned.inputs["Angle"].default_value = TILT
    graph.link(to_view.outputs[0], turned.inputs["Vector"])
    split = graph.node("ShaderNodeSeparateXYZ")
    graph.link(turned.outputs[0], split.inputs[0])

    # the tubes are rings about the (tilted) vertical of the view, at equal angles from it
    angle = graph.math("ARCSINE", split.outputs["Y"], 0.0)
    wave = graph.math("SINE", graph.math("MULTIPLY", angle, 2.0 * stripes), 0.0)
    edge = graph.node("ShaderNodeMapRange")
    edge.interpolation_type = "SMOOTHSTEP"
    edge.inputs["From Min"].default_value, edge.inputs["From Max"].default_value = -0.03, 0.03
    graph.link(wave, edge.inputs["Value"])
    colour = graph.node("ShaderNodeMix")
    colour.data_type = "RGBA"
    colour.inputs["A"].default_value, colour.inputs["B"].default_value = (*DARK, 1), (*LIGHT, 1)
    graph.link(edge.outputs["Result"], colour.inputs["Factor"])

    emission = graph.node("ShaderNodeEmission")
    graph.link(colour.outputs["Result"], emission.inputs["Color"])
    grey = graph.node(
        "ShaderNodeBsdfDiffuse"
    )  # what the floor sees: stripes shall not light the room
    seen = graph.node("ShaderNodeLightPath")
    mix = graph.node("ShaderNodeMixShader")
    graph.link(seen.outputs["Is Camera Ray"], mix.inputs[0])
    graph.link(grey.outputs[0], mix.inputs[1])
    graph.link(emission.outputs[0], mix.inputs[2])
    output = graph.node("ShaderNodeOutputMaterial")
    graph.link(mix.outputs[0], output.inputs["Surface"])
    return material


class _Graph:
    """A short way to write node graphs."""

    def __init__(self, tree):
        self.tree = tree
        tree.nodes.clear()

    def node(self, kind):
        return self.tree.nodes.new(kind)

    def link(self, output, target):
        self.tree.links.new(output, target)

    def vector(self, operation, first, second=None, scale=None):
        node = self.node("ShaderNodeVectorMath")
        node.operation = operation
        self.link(first, node.inputs[0])
        if second is not None:
            self.link(second, node.inputs[1])
        if scale is not None:
            node.inputs["Scale"].default_value = scale
        return node.outputs[0]

    def math(self, operation, first, second):
        node = self.node("ShaderNodeMath")
        node.operation = operation
        self.link(first, node.inputs[0])
        if isinstance(second, float):
            node.inputs[1].default_value = second
        else:
            self.link(second, node.inputs[1])
        return node.outputs[0]
