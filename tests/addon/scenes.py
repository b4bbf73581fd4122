# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes and what tests ask of them."""

import bpy
import numpy as np

CUBE = (
    [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)],
    [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)],
)
TRIANGLE = ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])


def add(name, vertices, faces, edges=()):
    """A new mesh object, selected alone and active."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, edges, faces)
    mesh.update()
    source = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(source)
    activate(source)
    return source


def add_suzanne():
    bpy.ops.mesh.primitive_monkey_add()
    return bpy.context.object


def activate(target):
    for other in bpy.context.selected_objects:
        other.select_set(False)
    target.select_set(True)
    bpy.context.view_layer.objects.active = target


def fair(**settings):
    """Runs the operator and returns the new active object."""
    assert bpy.ops.object.fairing_surface(**settings) == {"FINISHED"}
    return bpy.context.active_object


def positions(mesh):
    values = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


def face_values(mesh, name, dtype):
    values = np.empty(len(mesh.polygons), dtype)
    mesh.polygons.foreach_get(name, values)
    return values


def snapshot(source):
    """Everything about an object and its mesh that must not change, as bytes and plain values."""
    mesh = source.data
    attributes = {}
    for attribute in mesh.attributes:
        key = {"FLOAT_VECTOR": "vector", "FLOAT2": "vector", "FLOAT_COLOR": "color"}.get(
            attribute.data_type, "value"
        )
        attributes[attribute.name] = [
            tuple(value) if hasattr(value := getattr(item, key), "__len__") else value
            for item in attribute.data
        ]
    place = (
        [tuple(row) for row in source.matrix_world],
        source.parent,
        tuple(source.users_collection),
    )
    return attributes, place, [m and m.name for m in mesh.materials], source.name, mesh.name


def add_attribute(source, numbers, name="Loose"):
    """Gives each vertex one of the `numbers`, as a float attribute."""
    attribute = source.data.attributes.new(name, "FLOAT", "POINT")
    attribute.data.foreach_set("value", np.float32(numbers))


def set_edge_attribute(mesh, name, data_type, pairs, value, domain="EDGE"):
    """Gives the edges between the vertex `pairs` a value of the attribute `name`."""
    attribute = mesh.attributes.new(name, data_type, domain)
    wanted = {tuple(sorted(pair)) for pair in pairs}
    for edge in mesh.edges:
        if tuple(sorted(edge.vertices)) in wanted:
            attribute.data[edge.index].value = value
