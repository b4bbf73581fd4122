# SPDX-License-Identifier: GPL-3.0-or-later
"""Pads under the vertices of the source hold them; vertices whose pads gave way are shown."""

import bpy
import numpy as np
from refined import values
from scenes import add_attribute, fair, positions

from addon.errors import pads_text
from addon.memory import recall

CRUMPLED = {"levels": 2, "pad_size": 1.0, "energy": "TOTAL_CURVATURE"}


def add_crumpled():
    """A ball with half of its vertices off at random: steps to total curvature do not settle on pads."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2)
    ball = bpy.context.object
    points = positions(ball.data)
    random = np.random.default_rng(4)
    rough = (points[:, :1] > 0.0) * 1.0
    points = points * (1 + rough * random.uniform(-1, 1, len(points))[:, None])
    points += 0.5 * rough * random.uniform(-1, 1, points.shape)
    ball.data.vertices.foreach_set("co", points.astype(np.float32).ravel())
    return ball


def test_where_pads_gave_way_is_said_and_kept(capfd):
    source = add_crumpled()
    result = fair(**CRUMPLED)
    pads = recall(result, "report")["pads"]
    assert pads["gone"] == len(source.data.vertices)
    assert pads_text(pads) in capfd.readouterr().out
    widths = values(result.data, "fair_pad_size")
    assert np.array_equal(widths[: len(source.data.vertices)], np.float32(pads["widths"]))
    assert not widths.any()
    assert "1 vertex, where" in pads_text({"gone": 1, "widths": [0.5, 0.0]})


def test_recompute_replaces_where_pads_gave_way():
    source = add_crumpled()
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Up").data[0].co.z += 1.0
    result = fair(**CRUMPLED | {"levels": 1})
    assert "fair_pad_size" in result.data.attributes and len(result.data.shape_keys.key_blocks) == 2
    result.discrete_fairing.pad_size = 0.0
    bpy.ops.object.fairing_recompute()
    assert "fair_pad_size" not in result.data.attributes
    add_attribute(source, [0.75] * len(source.data.vertices), "fair_pad_size")
    bpy.ops.object.fairing_recompute()
    assert "fair_pad_size" not in result.data.attributes, "of the source, not of this surface"
