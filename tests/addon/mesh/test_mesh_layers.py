# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes, UV maps, colours, materials and marks go from a mesh object to the refined one."""

import bpy
import numpy as np
import pytest
from refined import edge_vertices, refine, values
from scenes import CUBE, add, add_attribute, set_edge_attribute

from addon.mesh.layers import read_data

DOMAINS = ["POINT", "EDGE", "FACE", "CORNER"]
SAMPLE = {
    "FLOAT": 0.1,
    "FLOAT2": (0.1, 0.7),
    "FLOAT_VECTOR": (0.1, 0.7, -3.3),
    "FLOAT_COLOR": (0.1, 0.7, 3.3, 1 / 3),
    "INT": -7,
    "INT8": -7,
    "INT16_2D": (3, -4),
    "INT32_2D": (300000, -4),
    "BOOLEAN": True,
    "QUATERNION": (0.5, 0.5, -0.5, 0.5),
    "FLOAT4X4": [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12], [13, 14, 15, 16]],
    "STRING": b"text",
}
FIELD = {
    "FLOAT2": "vector",
    "FLOAT_VECTOR": "vector",
    "FLOAT_COLOR": "color",
    "BYTE_COLOR": "color",
}


def cube():
    """A cube whose UV map is Blender's own, six squares with seams between most."""
    bpy.ops.mesh.primitive_cube_add()
    return bpy.context.object


def plain(value):
    is_plain = isinstance(value, bytes) or not hasattr(value, "__len__")
    return value if is_plain else np.asarray(value).tolist()


@pytest.mark.parametrize("data_type", SAMPLE)
def test_constant_attributes_stay_to_the_bit(data_type):
    for domain in DOMAINS:
        stays(data_type, domain)


def stays(data_type, domain):
    source = add("Cube", *CUBE)
    given = source.data.attributes.new("given", data_type, domain)
    field = FIELD.get(data_type, "value")
    for item in given.data:
        setattr(item, field, SAMPLE[data_type])
    expected = plain(getattr(given.data[0], field))
    made = refine(source)
    found = made.mesh.attributes["given"]
    assert (found.data_type, found.domain) == (data_type, domain)
    elements = range(len(found.data))
    if domain == "EDGE":
        elements = np.flatnonzero(on_control_edges(made))
        inside = np.setdiff1d(np.arange(len(found.data)), elements)
        unset = plain(getattr(found.data[int(inside[0])], field))
        assert unset == b"" if data_type == "STRING" else not np.any(unset)
    assert len(elements)
    assert all(plain(getattr(found.data[int(i)], field)) == expected for i in elements)
    assert made.mesh.validate() is False


def on_control_edges(made):
    """(refined edges,) bool, found by the positions of a cube: two coordinates of either end are 1 in size."""
    linear = made.transfer.point(made.arrays.positions)
    a, b = linear[edge_vertices(made.mesh)].transpose(1, 0, 2)
    return ((np.abs(a) == 1) & (a == b)).sum(axis=1) >= 2


def test_seams_stay_apart():
    """Where two faces of the control cube have different UVs at an edge, the refined faces have too."""
    source = cube()
    made = refine(source, 2)
    on_seam = on_control_edges(made)
    uv = values(made.mesh, "UVMap", "vector", 2)
    edge = values(made.mesh, ".corner_edge", dtype=np.int32)
    order = np.argsort(edge, kind="stable").reshape(-1, 2)  # the two corners that an edge leaves
    following = following_corner(made.mesh)
    one, other = order.T
    here = np.maximum(
        np.abs(uv[one] - uv[following[other]]).max(axis=1),
        np.abs(uv[following[one]] - uv[other]).max(axis=1),
    )
    assert (here[~on_seam] == 0).all()
    assert (here[on_seam] > 0).sum() == 7 * 4  # a cube unfolds along 7 of its 12 edges


def following_corner(mesh):
    starts, sizes = np.empty((2, len(mesh.polygons)), np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    mesh.polygons.foreach_get("loop_total", sizes)
    following = np.arange(1, len(mesh.loops) + 1)
    following[starts + sizes - 1] = starts
    return following


def test_active_maps_and_colors():
    source = cube()
    mesh = source.data
    for name in ("Second", "Third"):
        mesh.uv_layers.new(name=name)
    mesh.uv_layers.active = mesh.uv_layers["Second"]
    mesh.uv_layers["Third"].active_render = True
    for name in ("Paint", "More", "Last"):
        mesh.color_attributes.new(name, "FLOAT_COLOR", "POINT")
    mesh.attributes.active_color_name, mesh.attributes.default_color_name = "More", "Last"
    found = refine(source).mesh
    assert [layer.name for layer in found.uv_layers] == ["UVMap", "Second", "Third"]
    assert found.uv_layers.active.name == "Second"
    assert [layer.name for layer in found.uv_layers if layer.active_render] == ["Third"]
    assert found.attributes.active_color_name == "More"
    assert found.attributes.default_color_name == "Last"


RIM = [(0, 1), (1, 3), (3, 2), (2, 0)]


def test_seams_weights_and_freestyle_marks():
    source = add("Cube", *CUBE)
    for name in ("crease_edge", "bevel_weight_edge"):
        set_edge_attribute(source.data, name, "FLOAT", RIM, 0.3)
    for edge in source.data.edges:
        edge.use_seam = edge.use_freestyle_mark = set(edge.vertices) in [set(p) for p in RIM]
    source.data.polygons[2].use_freestyle_mark = True
    made = refine(source, 2)
    for name in ("crease_edge", "bevel_weight_edge"):
        found = values(made.mesh, name)
        assert set(found) == {np.float32(0.3), np.float32(0)}
        assert np.array_equal(found > 0, on_rim(made))
    for name in ("use_seam", "use_freestyle_mark"):
        found = np.empty(len(made.mesh.edges), bool)
        made.mesh.edges.foreach_get(name, found)
        assert np.array_equal(found, on_rim(made))
    marked = np.empty(len(made.mesh.polygons), bool)
    made.mesh.polygons.foreach_get("use_freestyle_mark", marked)
    assert np.flatnonzero(marked).tolist() == list(range(32, 48))


def on_rim(made):
    """The edges around the face x = -1 of the cube: 4 pieces of each of its 4 edges."""
    linear = made.transfer.point(made.arrays.positions)
    ends = linear[edge_vertices(made.mesh)]
    found = on_control_edges(made) & (ends[:, :, 0] == -1).all(axis=1)
    assert found.sum() == 16
    return found


def test_sculpt_layers_are_carried_and_hidden_faces_are_not():
    source = add("Cube", *CUBE)
    mesh = source.data
    add_attribute(source, np.full(8, 0.5), ".sculpt_mask")
    mesh.attributes.new(".sculpt_face_set", "INT", "FACE").data.foreach_set("value", np.arange(6))
    mesh.polygons[0].hide = True
    found = refine(source, 1).mesh
    assert (values(found, ".sculpt_mask") == 0.5).all()
    sets = values(found, ".sculpt_face_set", dtype=np.int32)
    assert np.array_equal(sets, np.repeat(range(6), 4))
    assert ".hide_poly" in source.data.attributes and ".hide_poly" not in found.attributes


def test_what_is_dropped_is_noted():
    loose = add("Cube", [*CUBE[0], (5, 5, 5)], CUBE[1], [(0, 8)])
    assert any("without a face" in note for note in read_data(loose, loose.data).notes)
    source = cube()
    assert read_data(source, source.data).notes == []
    source.data.normals_split_custom_set_from_vertices([(0, 0, 1)] * 8)
    made = refine(source)
    assert any("Custom normals" in note for note in made.data.notes)
    assert "UVMap" not in refine(source, leave_out=("UVMap",)).mesh.attributes
    assert not made.mesh.has_custom_normals
