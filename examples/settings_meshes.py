# SPDX-License-Identifier: GPL-3.0-or-later
"""Small objects that show what one setting does; each function makes one in the current scene and returns it."""

from itertools import product
from math import cos, pi, radians, sin

import bpy
import numpy as np
import offsets as example_offsets


def add(vertices, faces, name="Control"):
    """A mesh object, selected and active."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(map(float, v)) for v in vertices], [], faces)
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(thing)
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing
    return thing


def set_creases(control, weight):
    """`weight(a, b)` is the crease of the edge between two points."""
    points = [v.co for v in control.data.vertices]
    values = [weight(*(points[v] for v in edge.vertices)) for edge in control.data.edges]
    control.data.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", values)
    return control


def vase():
    """Six sides and four rings: coarse enough to see every face being split."""
    return _lathe(((0.45, 0.0), (0.95, 0.75), (0.42, 1.6), (0.62, 2.2)), 6)


def octahedron():
    """Six vertices on a sphere."""
    vertices = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    return add(vertices, faces)


def torus():
    """Twelve by eight quads, shaded smooth."""
    bpy.ops.mesh.primitive_torus_add(
        major_segments=12, minor_segments=8, major_radius=1.0, minor_radius=0.45
    )
    control = bpy.context.object
    control.rotation_euler = (radians(35), 0, 0)
    bpy.ops.object.transform_apply(rotation=True)
    control.data.shade_smooth()
    return control


def _boxes(cells, offset):
    """The outside of unit cubes."""
    ids, faces = {}, []

    def vertex(point):
        return ids.setdefault(point, len(ids))

    for cell, axis, side in product(cells, range(3), (0, 1)):
        neighbour = tuple(c + (2 * side - 1) * (i == axis) for i, c in enumerate(cell))
        if neighbour in cells:
            continue
        b, c = (axis + 1) % 3, (axis + 2) % 3
        corners = []
        for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
            point = list(cell)
            point[axis] += side
            point[b] += u
            point[c] += v
            corners.append(vertex(tuple(point)))
        faces.append(corners if side else corners[::-1])
    return add([np.add(point, offset) for point in ids], faces)


def box():
    """Two cubes on one another."""
    control = _boxes([(0, 0, 0), (0, 0, 1)], (-0.5, -0.5, 0))
    for vertex in control.data.vertices:
        vertex.co.z *= 0.5
    return control


def rimmed_box(top=1.0, bottom=0.0):
    """A box with a creased rim above, and if wished one below."""

    def weight(a, b):
        level = a.z == b.z
        return top if level and a.z == 1 else bottom if level and a.z == 0 else 0.0

    return set_creases(box(), weight)


def can(sides=12):
    """A prism with caps around a point each."""
    ring = [(cos(2 * pi * k / sides), sin(2 * pi * k / sides)) for k in range(sides)]
    heights = (0.0, 0.8, 1.6)
    vertices = [(x, y, z) for z in heights for x, y in ring]
    vertices += [(x / 2, y / 2, z) for z in (0.0, 1.6) for x, y in ring] + [(0, 0, 0), (0, 0, 1.6)]
    faces = []
    for k in range(sides):
        j = (k + 1) % sides
        for r in range(2):
            faces.append((r * sides + k, r * sides + j, (r + 1) * sides + j, (r + 1) * sides + k))
        low, high, inner, upper = 0, 2 * sides, 3 * sides, 4 * sides
        faces.append((low + j, low + k, inner + k, inner + j))
        faces.append((inner + j, inner + k, 5 * sides))
        faces.append((high + k, high + j, upper + j, upper + k))
        faces.append((upper + k, upper + j, 5 * sides + 1))
    return add(vertices, faces)


def marked_can():
    """A can whose upper rim is marked sharp."""
    control = can()
    for edge in control.data.edges:
        a, b = (control.data.vertices[v].co for v in edge.vertices)
        edge.use_edge_sharp = a.z == b.z and a.z > 1.5 and min(a.xy.length, b.xy.length) > 0.9
    return control


def tent(height=1.5):
    """An open sheet of four quads, drawn up in the middle."""
    vertices = [(x, y, height * (1 - max(abs(x), abs(y)))) for x in (-1, 0, 1) for y in (-1, 0, 1)]
    faces = [(i, i + 3, i + 4, i + 1) for i in (0, 1, 3, 4)]
    return add(_lifted(vertices, 0.35), faces)


def tent_with_side(boundary):
    """A tent whose front side has a boundary of its own: 2 straight, 3 free."""
    control = tent()
    points = [v.co for v in control.data.vertices]
    values = [boundary * all(points[v].y == -1 for v in e.vertices) for e in control.data.edges]
    control.data.attributes.new("fair_boundary", "INT", "EDGE").data.foreach_set("value", values)
    return control


def sheet_with_normal(degrees=None):
    """A flat sheet of four quads; the normal in its middle is fixed at this angle from upright."""
    control = tent(0)
    if degrees is not None:
        layer = control.data.attributes.new("fair_normal", "FLOAT_VECTOR", "POINT")
        layer.data[4].vector = (sin(radians(degrees)), 0, cos(radians(degrees)))
    return control


def _lifted(vertices, height):
    """The points and one more, of no face, on the floor, so that the mesh stands above it."""
    return [*vertices, (0, 0, -height)]


def scan():
    """A ball as a poor scanner sees it."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=1.0)
    control = bpy.context.object
    random = np.random.default_rng(5)
    for vertex, noise in zip(control.data.vertices, random.normal(0, 0.012, 1000)):
        vertex.co *= 1 + noise
    return control


def finned():
    """A body with a thin fin."""
    fin = {(2, 0, 1), (2, 0, 2), (3, 0, 2)}
    control = _boxes([(i, 0, 0) for i in range(4)] + sorted(fin), (-2.5, -0.5, 0))
    for vertex in control.data.vertices:
        if vertex.co.z > 1:
            vertex.co.y *= 0.12
    return control


def uneven():
    """A bottle of eight sides, its rings close together at some places and far apart at others."""
    profile = (
        (0.30, 0.0),
        (0.62, 0.06),
        (0.70, 0.20),
        (0.70, 1.30),
        (0.62, 1.42),
        (0.30, 1.55),
        (0.24, 1.70),
        (0.24, 2.3),
    )
    return _lathe(profile, 8)


def _lathe(profile, sides):
    vertices = [(0, 0, profile[0][1]), (0, 0, profile[-1][1])]
    for radius, height in profile:
        vertices += [
            (radius * cos(2 * pi * k / sides), radius * sin(2 * pi * k / sides), height)
            for k in range(sides)
        ]
    faces = []
    last = 2 + (len(profile) - 1) * sides
    for k in range(sides):
        j = (k + 1) % sides
        faces.append((0, 2 + j, 2 + k))
        faces.append((1, last + k, last + j))
        for r in range(len(profile) - 1):
            low, high = 2 + r * sides, 2 + (r + 1) * sides
            faces.append((low + k, low + j, high + j, high + k))
    return add(vertices, faces)


def ramp():
    """A low plate, a high one, and the ramp between them, whose faces are selected."""
    columns = ((-4, 0.0), (-2, 0.0), (0, 0.9), (2, 1.8), (4, 1.8))
    rows = range(-2, 3, 2)
    vertices = [(x, y, z) for x, z in columns for y in rows]
    count = len(rows)
    faces = [
        (i * count + j, (i + 1) * count + j, (i + 1) * count + j + 1, i * count + j + 1)
        for i, j in product(range(len(columns) - 1), range(count - 1))
    ]
    control = add(_lifted(vertices, 0.4), faces)
    for face in control.data.polygons:
        face.select = abs(face.center.x) < 2
    return control


def suzanne():
    bpy.ops.mesh.primitive_monkey_add()
    return bpy.context.object


def half_suzanne():
    """One half of Suzanne, with a Mirror modifier for the other."""
    control = suzanne()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.bisect(plane_co=(0, 0, 0), plane_no=(1, 0, 0), clear_inner=True)
    bpy.ops.object.mode_set(mode="OBJECT")
    for vertex in control.data.vertices:
        if abs(vertex.co.x) < 1e-4:
            vertex.co.x = 0
    control.modifiers.new("Mirror", "MIRROR")
    return control


def suzanne_with_key():
    """Suzanne with a shape key that draws her ears out."""
    control = suzanne()
    control.shape_key_add(name="Basis")
    key = control.shape_key_add(name="Long Ears")
    for point in key.data:
        far = max(0.0, abs(point.co.x) - 0.78)
        point.co.z += 1.9 * far
        point.co.x *= 1 - 0.25 * far
    return control


def bent_column():
    """A column of square rings on an armature of two bones, the upper one bent."""
    profile = [(0.36, z) for z in np.linspace(0, 2.4, 9)]
    control = _lathe(profile, 6)
    bones = bpy.data.armatures.new("Bones")
    rig = bpy.data.objects.new("Bones", bones)
    bpy.context.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for name, low, high in (("Lower", 0, 1.2), ("Upper", 1.2, 2.4)):
        bone = bones.edit_bones.new(name)
        bone.head, bone.tail = (0, 0, low), (0, 0, high)
    bones.edit_bones["Upper"].parent = bones.edit_bones["Lower"]
    bpy.ops.object.mode_set(mode="POSE")
    pose = rig.pose.bones["Upper"]
    pose.rotation_mode = "XYZ"
    pose.rotation_euler = (0, 0, radians(-55))
    bpy.ops.object.mode_set(mode="OBJECT")
    groups = [control.vertex_groups.new(name=name) for name in ("Lower", "Upper")]
    for vertex in control.data.vertices:
        upper = float(np.clip((vertex.co.z - 0.6) / 1.2, 0, 1))
        groups[0].add([vertex.index], 1 - upper, "REPLACE")
        groups[1].add([vertex.index], upper, "REPLACE")
    control.modifiers.new("Armature", "ARMATURE").object = rig
    bpy.context.view_layer.objects.active = control
    rig.hide_render = True
    rig.select_set(False)
    control.select_set(True)
    return control


def offsets():
    """Half a hull from its table of offsets, with some wrong ones; upside down, as on a mould."""
    example_offsets.add_to_scene()
    control = bpy.data.objects["Offsets"]
    control.location.x = -0.5 * example_offsets.LENGTH / 1000
    control.rotation_euler.x = pi
    bpy.context.view_layer.update()
    bpy.context.view_layer.objects.active = control
    control.select_set(True)
    bpy.context.scene.discrete_fairing.symmetry_plane = "Y"
    return control


def eased_offsets():
    """The same hull with the shape key Eased: first the three wrong offsets, then all."""
    control = offsets()
    bpy.ops.object.fairing_ease(amount="WORST", count=len(example_offsets.WRONG))
    bpy.ops.object.fairing_ease(amount="AUTOMATIC", go_on=True)
    return control
