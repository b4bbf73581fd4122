# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes, and questions about them."""

from contextlib import contextmanager
from pathlib import Path

import bmesh
import bpy
import numpy as np
import pytest
from scans import sheet

from addon.settings import Settings

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
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


def add_sheet(name, along, across, height):
    """The graph of a function over a grid, in quads."""
    points, faces = sheet(along, across, height)
    return add(name, points.tolist(), faces.tolist())


def add_ball(name, subdivisions, radius=1.0, noise=0.0):
    """An icosphere, its vertices off the sphere by noise, rms as a share of the radius."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=subdivisions, radius=radius, calc_uvs=False)
    made = bpy.context.object
    made.name = name
    points = positions(made.data)
    length = np.random.default_rng(1).normal(1, noise, (len(points), 1))
    made.data.vertices.foreach_set("co", np.float32(points * length).ravel())
    made.data.update()
    return made


def add_suzanne():
    bpy.ops.mesh.primitive_monkey_add()
    return bpy.context.object


def add_rounded_box(size, rim, segments):
    """A box with rounded rims; its six flats come last."""
    bpy.ops.mesh.primitive_cube_add(size=1.0)
    made = bpy.context.object
    made.data.transform(np.diag([*size, 1.0]).tolist())
    edit(made, "FACE", range(6))
    bpy.ops.mesh.bevel(offset=rim, segments=segments, profile=0.5)
    to_object_mode()
    return made


def activate(*targets):
    """Selects these objects alone; the last one is active."""
    for other in bpy.context.selected_objects:
        other.select_set(False)
    for target in targets:
        target.select_set(True)
    bpy.context.view_layer.objects.active = targets[-1]


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
    """All of an object and its mesh that must not change, as bytes and plain values."""
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


def again(source, **settings):
    """Another surface of a source that the last surface has hidden."""
    source.hide_set(False)
    activate(source)
    return fair(**settings)


def recompute(target=None):
    if target is not None:
        activate(target)
    assert bpy.ops.object.fairing_recompute() == {"FINISHED"}


def reopen(tmp_path):
    """Saves the file and opens it again."""
    path = str(tmp_path / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    return path


def settings(**changes):
    """The settings of the scene, after these changes."""
    scene = bpy.context.scene.discrete_fairing
    for name, value in changes.items():
        setattr(scene, name, value)
    return Settings.of(scene)


def computed(job):
    job.compute()
    return job


def shown(target):
    """The vertices of an object after modifiers and shape keys."""
    return positions(target.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh())


def weights(target, name):
    """(N,) weight of each vertex in a group, NaN outside of it."""
    group = target.vertex_groups[name].index
    found = np.full(len(target.data.vertices), np.nan)
    for vertex in target.data.vertices:
        for element in vertex.groups:
            if element.group == group:
                found[vertex.index] = element.weight
    return found


@contextmanager
def bmesh_of(mesh):
    """A BMesh of a mesh, written back at the end."""
    bm = bmesh.new()
    bm.from_mesh(mesh)
    yield bm
    bm.to_mesh(mesh)
    bm.free()


def faces_at_edges(mesh):
    """How many faces each edge has."""
    counts = np.zeros(len(mesh.edges), int)
    for polygon in mesh.polygons:
        counts[[mesh.loops[k].edge_index for k in polygon.loop_indices]] += 1
    return counts.tolist()


def edit(target, kind, chosen=()):
    """Enters Edit Mode with these vertices, edges or faces selected."""
    activate(target)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_mode(type=kind)
    bpy.ops.mesh.select_all(action="DESELECT")
    to_object_mode()
    mesh = target.data
    parts = {"VERT": mesh.vertices, "EDGE": mesh.edges, "FACE": mesh.polygons}[kind]
    for index in chosen:
        parts[int(index)].select = True
    bpy.ops.object.mode_set(mode="EDIT")


def to_object_mode():
    bpy.ops.object.mode_set(mode="OBJECT")


def moved(source, result):
    """The distance of the surface from each control vertex."""
    count = len(source.data.vertices)
    return np.linalg.norm(positions(result.data)[:count] - positions(source.data), axis=1)


def add_group(source, weights, name="Loose"):
    """A vertex group of {vertex: weight}."""
    group = source.vertex_groups.new(name=name)
    for vertex, weight in weights.items():
        group.add([vertex], weight, "REPLACE")


def refused(match, operator, *how, **options):
    """The operator ends with an error whose text matches."""
    with pytest.raises(RuntimeError, match=match):
        operator(*how, **options)


def exclude(*objects):
    """Puts objects into an excluded collection of their own."""
    hidden = bpy.data.collections.new("Hidden")
    bpy.context.scene.collection.children.link(hidden)
    for one in objects:
        for collection in one.users_collection:
            collection.objects.unlink(one)
        hidden.objects.link(one)
    bpy.context.view_layer.layer_collection.children["Hidden"].exclude = True
