# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys keep their settings, and get the positions that they are given."""

import bpy
import numpy as np
import pytest
from refined import refine
from scenes import CUBE, add, shown

from addon.mesh.shape_keys import mixed, read_shape_keys, write_shape_keys


@pytest.fixture
def source():
    made = add("Cube", *CUBE)
    made.vertex_groups.new(name="Half").add(range(4), 1.0, "REPLACE")
    made.shape_key_add(name="Basis")
    for name, shift in (("Wide", (1, 0, 0)), ("Tall", (0, 0, 2))):
        key = made.shape_key_add(name=name)
        for point in key.data:
            point.co = np.multiply(point.co, np.add(1, np.multiply(0.5, shift)))
    keys = made.data.shape_keys.key_blocks
    keys["Wide"].slider_min, keys["Wide"].slider_max, keys["Wide"].value = -2.0, 3.0, 2.5
    keys["Tall"].relative_key, keys["Tall"].mute = keys["Wide"], True
    keys["Tall"].vertex_group, keys["Tall"].interpolation = "Half", "KEY_CARDINAL"
    made.active_shape_key_index = 2
    return made


def shaped(source):
    """The refined object with keys that are refined linearly."""
    made = refine(source)
    made.shapes = [made.transfer.point(shape) for shape in made.data.shape_keys.shapes]
    write_shape_keys(made.target, made.data.shape_keys, made.shapes, source)
    return made


def test_settings(source):
    made = shaped(source)
    given, found = source.data.shape_keys.key_blocks, made.mesh.shape_keys.key_blocks
    assert [k.name for k in found] == ["Basis", "Wide", "Tall"]
    for name in ("slider_min", "slider_max", "value", "mute", "vertex_group", "interpolation"):
        assert [getattr(k, name) for k in found] == [getattr(k, name) for k in given]
    assert found["Tall"].relative_key == found["Wide"]
    assert made.target.active_shape_key_index == 2
    assert made.mesh.validate() is False


@pytest.mark.parametrize("kinds", ["LLLL", "CCCC", "RRRR", "BBBB", "LCRB", "BLBL", "RLCB"])
def test_absolute_keys_are_mixed_as_blender_does(kinds):
    """The mix is the mesh that Blender shows, for each kind of curve between keys, also between two kinds."""
    names = {"L": "LINEAR", "C": "CARDINAL", "R": "CATMULL_ROM", "B": "BSPLINE"}
    made = add("Cube", *CUBE)
    rng = np.random.default_rng(1)
    for kind in kinds:
        key = made.shape_key_add(from_mix=False)
        key.data.foreach_set("co", rng.standard_normal(24).astype(np.float32))
        key.interpolation = f"KEY_{names[kind]}"
    made.data.shape_keys.use_relative = False
    for time in (-5.0, 0.0, 3.0, 10.0, 14.0, 27.0, 30.0, 99.0):
        made.data.shape_keys.eval_time = time
        bpy.context.view_layer.update()
        found = mixed(read_shape_keys(made, 8), lambda _: np.ones(8))
        assert np.abs(found - shown(made)).max() < 1e-5, time
