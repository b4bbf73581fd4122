# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input gives a sentence that names the fault, and makes nothing."""

import re
from pathlib import Path

import bpy
import discrete_fairing as df
import numpy as np
import pytest
from scenes import CUBE, add

from addon import errors


def expect_refusal(match, **settings):
    before = len(bpy.data.objects), len(bpy.data.meshes)
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.fairing_surface(**settings)
    assert (len(bpy.data.objects), len(bpy.data.meshes)) == before


@pytest.mark.parametrize(
    ("points", "edges", "faces", "match"),
    [
        ([(0, 0, 0), (1, 0, 0)], [(0, 1)], [], "Bad: .*face"),
        ([], [], [], "Bad: "),
        ([(float("nan"), 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)], "Bad: .*finite"),
    ],
)
def test_what_is_no_surface(points, edges, faces, match):
    add("Bad", points, faces, edges)
    expect_refusal(match)
    bpy.ops.object.mode_set(mode="EDIT")
    expect_refusal(match)
    assert bpy.context.mode == "EDIT_MESH", "as it was"
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.mode_set(mode="SCULPT")
    expect_refusal("Object Mode")


def test_more_than_a_mesh_can_hold():
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=50, y_subdivisions=50)
    expect_refusal("fewer levels", levels=10)


# what no mesh from Blender brings about, or the core says what to do itself
OF_SCRIPTS = {"BAD_SHAPE", "INDEX_OUT_OF_RANGE", "BAD_FEATURE_EDGE", "FORKED", "CANCELLED"}
OWN_CURE = {"BAD_OPTION"}


def test_every_code_of_the_core_has_a_remedy():
    text = (Path(__file__).parents[2] / "native" / "base" / "error.cpp").read_text("utf-8")
    codes = set(re.findall(r'case ErrorCode::\w+: return "(\w+)";', text))
    assert codes
    for remedies in (errors.REMEDIES, errors.WITHOUT_MENDING, errors.OF_HOLES):
        assert codes - OF_SCRIPTS - OWN_CURE - remedies.keys() == set()


def test_a_swollen_body_names_the_settings_as_the_panel_does():
    plate = np.array(CUBE[0]) * (1, 1, 0.2)
    report = df.fair(plate, CUBE[1], levels=2, energy="total_curvature").report
    (warning,) = [w for w in report["warnings"] if w["code"] == "THICKNESS_CHANGED"]
    assert 'energy="thin_plate"' in warning["cure"] and "{" not in warning["message"]
    text = errors.warning_text("Box", warning)
    assert text.startswith("Box: Set Fairness to Bending, raise Tension, set Vertices to Limit,")
    assert "energy" not in text
