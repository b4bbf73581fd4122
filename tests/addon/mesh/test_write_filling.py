# SPDX-License-Identifier: GPL-3.0-or-later
"""Holes filled in Object Mode: the mesh keeps all that it had."""

import bpy
import numpy as np
import pytest
from hole_scenes import ball, borders, is_closed, without

from addon.mesh.layers import fill_layer, layer_values, read_attributes

LAYERS = [
    ("FLOAT", "POINT"),
    ("FLOAT_VECTOR", "CORNER"),
    ("FLOAT2", "POINT"),
    ("FLOAT_COLOR", "POINT"),
    ("BYTE_COLOR", "CORNER"),
    ("INT", "FACE"),
    ("INT8", "CORNER"),
    ("INT32_2D", "POINT"),
    ("BOOLEAN", "EDGE"),
    ("QUATERNION", "FACE"),
    ("STRING", "POINT"),
]


def open_ball(keys=False):
    target = without(ball(), lambda c: abs(c[2]) > 0.7)
    if keys:
        target.shape_key_add(name="Basis")
    return target


def with_layers(target):
    rng = np.random.default_rng(3)
    for data_type, domain in LAYERS:
        layer = target.data.attributes.new(f"{data_type} {domain}", data_type, domain)
        values = layer_values(layer)
        if data_type == "STRING":
            fresh = np.array([b"a%d" % (i % 5) for i in range(len(values))], object)
        elif data_type == "BYTE_COLOR":
            layer.data.foreach_set("color_srgb", rng.integers(0, 256, values.size) / 255.0)
            continue
        else:
            fresh = (100 * rng.random(values.shape)).astype(values.dtype)
        fill_layer(layer, fresh)
    return target


def attributes(mesh):
    return {a.name: a.values for a in read_attributes(mesh)[0]}


def selected(mesh):
    return [
        {e.index for e in elements if e.select}
        for elements in (mesh.vertices, mesh.edges, mesh.polygons)
    ]


def test_all_that_was_there_stays_to_the_bit():
    target = with_layers(open_ball())
    mesh = target.data
    before, edges = attributes(mesh), [tuple(e.vertices) for e in mesh.edges]
    faces = [tuple(f.vertices) for f in mesh.polygons]
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    after = attributes(mesh)
    assert before.keys() == after.keys()
    for name, values in before.items():
        same = after[name][: len(values)]
        assert same.dtype == values.dtype
        assert same.tolist() == values.tolist(), name
    assert [tuple(e.vertices) for e in mesh.edges][: len(edges)] == edges
    assert [tuple(f.vertices) for f in mesh.polygons][: len(faces)] == faces


@pytest.mark.parametrize("keys", [False, True])
def test_the_mesh_is_sound_and_what_is_new_is_selected(keys):
    target = open_ball(keys)
    mesh = target.data
    faces, rim = len(mesh.polygons), {v for e in borders(target) for v in mesh.edges[e].vertices}
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    assert not mesh.validate(verbose=True)
    assert is_closed(mesh)
    assert len(mesh.vertices) - len(mesh.edges) + len(mesh.polygons) == 2
    vertices, _, chosen = selected(mesh)
    assert chosen == set(range(faces, len(mesh.polygons)))
    assert vertices == {v for f in chosen for v in mesh.polygons[f].vertices} >= rim


def test_what_cannot_be_mixed_comes_from_the_rim():
    target = with_layers(open_ball())
    mesh = target.data
    counts = {"POINT": len(mesh.vertices), "CORNER": len(mesh.loops), "FACE": len(mesh.polygons)}
    before = attributes(mesh)
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    for name, values in attributes(mesh).items():
        domain = mesh.attributes[name].domain
        if domain in counts and mesh.attributes[name].data_type in {"INT", "INT8", "STRING"}:
            new = values[counts[domain] :].tolist()
            assert len(new) and set(new) <= set(before[name].tolist())
    marks = attributes(mesh)["BOOLEAN EDGE"][len(before["BOOLEAN EDGE"]) :]
    assert len(marks) and not marks.any()


@pytest.mark.parametrize("keys", [False, True])
def test_marks_of_vertices_are_not_spread(keys):
    target = open_ball(keys)
    count = len(target.data.vertices)
    crease = target.data.attributes.new("crease_vert", "FLOAT", "POINT")
    fill_layer(crease, np.ones(count, np.float32))
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    values = attributes(target.data)["crease_vert"]
    assert (values[:count] == 1.0).all() and not values[count:].any()
