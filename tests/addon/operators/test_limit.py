# SPDX-License-Identifier: GPL-3.0-or-later
"""Through the limit positions, which are those of Blender's Subdivision Surface modifier."""

import bpy
import numpy as np
import pytest
from scenes import CUBE, add, add_suzanne, again, edit, fair, positions, shown, to_object_mode


def subdivided(source):
    """(n, 3): where the modifier puts the vertices of `source`."""
    with_modifier(source, levels=6, quality=10)
    found = shown(source)[: len(source.data.vertices)]
    source.modifiers.remove(source.modifiers["Subdivision"])
    return found


def crease(source, name, domain, values):
    source.data.attributes.new(name, "FLOAT", domain).data.foreach_set("value", np.float32(values))


def limits(source, **settings):
    result = again(
        source, **{"levels": 0, "interpolation": "LIMIT", "boundary": "CURVE"} | settings
    )
    return positions(result.data)[: len(source.data.vertices)]


def shaken(source, amount=0.1):
    noise = np.random.default_rng(1).standard_normal((len(source.data.vertices), 3))
    moved = positions(source.data) + amount * noise
    source.data.vertices.foreach_set("co", moved.astype(np.float32).ravel())
    source.data.update()
    return source


def soccer_ball():
    """Pentagons and triangles: the corners of an icosahedron cut off halfway."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=1)
    edit(bpy.context.object, "VERT", range(12))
    bpy.ops.mesh.bevel(affect="VERTICES", offset_type="PERCENT", offset_pct=50)
    bpy.ops.mesh.remove_doubles(threshold=1e-3)
    to_object_mode()
    return bpy.context.object


def sheet():
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=6, y_subdivisions=4)
    return bpy.context.object


MODELS = {
    "cube": lambda: add("Cube", *CUBE),
    "suzanne": add_suzanne,
    "ball": soccer_ball,
    "sheet": lambda: shaken(sheet()),
}


@pytest.mark.parametrize("model", MODELS)
def test_limits_are_those_of_the_modifier(model):
    source = MODELS[model]()
    assert np.abs(limits(source) - subdivided(source)).max() < 1e-4


@pytest.mark.parametrize("model", MODELS)
def test_semi_sharp_edges_and_vertices_too(model):
    source = MODELS[model]()
    random = np.random.default_rng(3)
    edges, vertices = len(source.data.edges), len(source.data.vertices)
    chosen = random.random(edges) < 0.3
    crease(source, "crease_edge", "EDGE", np.where(chosen, random.uniform(0.1, 0.62, edges), 0))
    chosen = random.random(vertices) < 0.1
    crease(source, "crease_vert", "POINT", np.where(chosen, random.uniform(0.1, 0.62, vertices), 0))
    smooth = limits(source, use_crease_attribute=False)
    found, wanted = limits(source, crease_threshold=1.0), subdivided(source)
    assert np.abs(found - smooth).max() > 0.01
    assert np.abs(found - wanted).max() < 1e-4
    # what is sharp enough to be a crease of the surface is as sharp as it was on the way there
    assert np.abs(limits(source, crease_threshold=0.3) - wanted).max() < 1e-4


def with_modifier(source, **settings):
    modifier = source.modifiers.new("Subdivision", "SUBSURF")
    for name, value in settings.items():
        setattr(modifier, name, value)
    return source


def test_automatic_is_limit_where_the_modifier_is():
    source = with_modifier(add_suzanne())
    result = fair(levels=1)
    assert result.discrete_fairing.interpolation == "LIMIT"
    count = len(source.data.vertices)
    expected = limits(with_modifier(source, show_viewport=False))
    np.testing.assert_allclose(positions(result.data)[:count], expected, atol=1e-6)


@pytest.mark.parametrize("given", [{"show_viewport": False}, {"subdivision_type": "SIMPLE"}, None])
def test_automatic_is_through_where_it_is_not(given):
    source = add_suzanne()
    if given is not None:
        with_modifier(source, **given)
    result = fair(levels=1)
    assert result.discrete_fairing.interpolation == "EXACT"
    count = len(source.data.vertices)
    np.testing.assert_array_equal(positions(result.data)[:count], positions(source.data))


@pytest.mark.parametrize("interpolation", ["AUTO", "EXACT"])
def test_the_modifier_is_not_applied_twice(interpolation):
    source = with_modifier(add_suzanne())
    source.modifiers.new("Other", "TRIANGULATE")
    result = again(source, levels=1, copy_modifiers=True, interpolation=interpolation)
    assert [m.type for m in result.modifiers] == ["TRIANGULATE"]


@pytest.mark.parametrize("interpolation", ["AUTO", "LIMIT"])
def test_a_mesh_that_is_subdivided_already_is_faired_through_its_vertices(interpolation):
    source = with_modifier(add_suzanne())
    given = shown(source)
    result = fair(levels=1, mesh_source="EVALUATED", interpolation=interpolation)
    np.testing.assert_allclose(positions(result.data)[: len(given)], given, atol=1e-6)
