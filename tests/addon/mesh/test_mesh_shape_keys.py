# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys keep their settings, and get the positions that they are given."""

import numpy as np
import pytest
from refined import refine
from scenes import CUBE, add

from addon.mesh.shape_keys import write_shape_keys


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
