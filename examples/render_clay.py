# SPDX-License-Identifier: GPL-3.0-or-later
"""Clay: matte, slightly warm, without a texture that hides faults. Control meshes get a thin wire, their creases a red one."""

import bpy
from render_studio import dress

CLAY = (0.50, 0.405, 0.325)
WIRE = (0.055, 0.06, 0.07)
CREASE = (0.62, 0.07, 0.025)


def dress_in_clay(control, result):
    for target in (control, result):
        dress(target, clay())
    creased = creased_edges(control.data)
    plain = sorted({*range(len(control.data.edges))} - {*creased})
    wires = [add_wire(control, plain, "Wire", WIRE, 0.0055)]
    if creased:
        wires.append(add_wire(control, creased, "Crease", CREASE, 0.012))
    return wires


def clay():
    return matte("Clay", CLAY, roughness=0.5)


def creased_edges(mesh):
    """Ids of the edges with a crease weight, in ascending order."""
    creases = mesh.attributes.get("crease_edge")
    return (
        [] if creases is None else [i for i, crease in enumerate(creases.data) if crease.value > 0]
    )


def matte(name, colour, roughness):
    """A material without gloss."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    shader.inputs["Roughness"].default_value = roughness
    shader.inputs["Specular IOR Level"].default_value = 0.35
    return material


def add_wire(source, edges, name, colour, thickness):
    """These `edges` (ids) of `source` as thin round bars, `thickness` across in the picture's units."""
    mesh = source.data
    curve = bpy.data.curves.new(name, "CURVE")
    curve.dimensions = "3D"
    curve.bevel_depth = thickness / 2 / source.scale[0]
    curve.bevel_resolution = 2
    for edge in edges:
        spline = curve.splines.new("POLY")
        spline.points.add(1)
        for point, vertex in zip(spline.points, mesh.edges[edge].vertices, strict=True):
            point.co = (*mesh.vertices[vertex].co, 1)
    curve.materials.append(matte(name, colour, roughness=0.8))
    wire = bpy.data.objects.new(name, curve)
    bpy.context.scene.collection.objects.link(wire)
    wire.matrix_world = source.matrix_world
    return wire
