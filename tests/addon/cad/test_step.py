# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Export > Fair Surface (.step): the file, the messages and the refusals."""

import re
from math import pi, sqrt

import bpy
import numpy as np
import pytest
import step_files
from fake_layout import draw
from scenes import CUBE, activate, add, fair

from addon import core
from addon.ui import main

# two faces folded onto one another but for a little: no surface through them is resolved
FOLDED = (
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.02, 0, 0.02), (0.02, 1, 0.02)],
    [(0, 1, 2, 3), (1, 4, 5, 2)],
)
RADIUS = sqrt(3)


def export(path, **settings):
    return bpy.ops.export_scene.fairing_step(filepath=str(path), **settings)


def sphere(name="Ball"):
    """A cube whose fair surface is a sphere of the radius √3."""
    bpy.context.scene.discrete_fairing.energy = "TOTAL_CURVATURE"
    return add(name, *CUBE)


def names(path):
    text = path.read_text()
    return [line.split("'")[1] for line in text.splitlines() if "=PRODUCT('" in line]


def test_a_mesh_becomes_a_solid_by_the_settings_of_the_scene(tmp_path, capfd):
    sphere()
    assert export(tmp_path / "ball.step") == {"FINISHED"}
    told = [line for line in capfd.readouterr().out.splitlines() if line.startswith("Info: ")]
    assert len(told) == 1 and re.fullmatch(
        r"Info: 6 patches, 0\.\d+ mm off a surface known to 0\.\d+ mm, 0\.\d+° at edges", told[0]
    )
    found = step_files.read(tmp_path / "ball.step")
    assert (found.valid, found.solids, found.faces) == (True, 1, 6)
    radius = 1000 * RADIUS
    assert found.volume == pytest.approx(4 / 3 * pi * radius**3, rel=2e-4)
    assert np.allclose(found.highest, radius, atol=1e-4 * 2 * radius)


@pytest.mark.parametrize("unit", ["MM", "IN", "NONE"])
def test_place_scale_and_units_are_applied(tmp_path, unit):
    ball = sphere()
    ball.location, ball.rotation_euler = (5, -1, 2), (0, 0, pi / 2)
    ball.scale = (-1, 1, 2)  # mirrored too
    units, told = bpy.context.scene.unit_settings, 1  # without a unit numbers stay
    if unit == "NONE":
        units.system, unit = unit, "MM"
    else:
        units.scale_length, told = 0.01, 10
    path = tmp_path / "ball.step"
    export(path, unit=unit)
    found = step_files.read(path)
    assert found.valid and found.solids == 1 and found.volume > 0
    assert np.allclose(found.centre, np.multiply(told, (5, -1, 2)), atol=2e-3 * told)
    size = np.subtract(found.highest, found.lowest)
    # the corners of a box that is twice as high lie on a sphere too
    assert np.allclose(size, 2 * told * sqrt(6), rtol=1e-3)


def test_a_surface_is_written_by_its_own_settings_where_it_stands(tmp_path, capfd):
    ball = sphere()
    assert "export_scene.fairing_step" not in draw(main.VIEW3D_PT_fairing)
    surface = fair(energy="TOTAL_CURVATURE", levels=2)
    assert "export_scene.fairing_step" in draw(main.VIEW3D_PT_fairing)
    surface.location = (7, 0, 0)
    for name, kind in (("Twin", "MIRROR"), ("Round", "SUBSURF")):
        surface.modifiers.new(name, kind)
    bpy.context.scene.discrete_fairing.energy = "THIN_PLATE"  # for the next one
    ball.hide_set(False)
    ball.select_set(True)  # its surface stands for it
    path = tmp_path / "ball.step"
    export(path)
    assert names(path) == ["Ball Fair"]
    assert "Ball Fair: The surface is without Twin and Round: its own" in capfd.readouterr().out
    found = step_files.read(path)
    assert found.solids == 1
    assert np.allclose(found.centre, (7000, 0, 0), atol=0.5)
    assert found.volume == pytest.approx(4 / 3 * pi * (1000 * RADIUS) ** 3, rel=2e-4)


def test_modifiers_of_a_mesh_that_are_left_out_are_said(tmp_path, capfd):
    """Half of a mirrored hull was written without a word."""
    sphere().modifiers.new("Twin", "ARRAY")
    export(tmp_path / "ball.step")
    assert "The surface is without Twin: set Control Mesh" in capfd.readouterr().out
    bpy.context.scene.discrete_fairing.mesh_source = "EVALUATED"
    export(tmp_path / "two.step")
    assert "without" not in capfd.readouterr().out


def test_several_objects_become_parts_with_names_and_colours(tmp_path):
    first, second = sphere("Left"), sphere("Right")
    second.location.x = 5
    for target, colour in ((first, (1, 0, 0, 1)), (second, (0, 0, 1, 1))):
        material = bpy.data.materials.new(target.name)
        material.diffuse_color = colour
        target.data.materials.append(material)
    first.select_set(True)
    path = tmp_path / "both.step"
    export(path)
    assert sorted(names(path)) == ["Left", "Right"]
    text = path.read_text()
    assert "COLOUR_RGB('',1.0,0.0,0.0)" in text and "COLOUR_RGB('',0.0,0.0,1.0)" in text
    assert step_files.read(path).solids == 2


def test_a_surface_that_folds_is_refused_and_its_faces_are_listed(tmp_path, capfd, monkeypatch):
    native = core.module()._native
    monkeypatch.setattr(native, "fit_splines", lambda *_: pytest.fail("fitted in vain"))
    folded = add("Leaf", *FOLDED)
    path = tmp_path / "leaf.step"
    path.write_text("old")
    with pytest.raises(RuntimeError, match="Nothing was written: the surface of Leaf folds"):
        export(path)
    assert path.read_text() == "old" and len(list(tmp_path.iterdir())) == 1
    told = capfd.readouterr().out
    assert "Leaf: Move or add vertices there, crease the edges" in told  # what to do comes first
    assert "2 faces have a surface that folds" in told and "Faces 0 and 1." in told
    activate(folded)
    assert bpy.ops.object.fairing_select_defect(index=0) == {"FINISHED"}
    assert sum(face.select for face in folded.data.polygons) == 2


def test_who_insists_gets_the_faces_marked(tmp_path, capfd):
    add("Leaf", *FOLDED)
    path = tmp_path / "leaf.step"
    assert export(path, force=True) == {"FINISHED"}
    assert "COLOUR_RGB('',1.0,0.0,0.0)" in path.read_text()
    assert "2 faces have a surface that folds" in capfd.readouterr().out


def test_faces_that_miss_are_listed_with_the_distance_and_the_cure(tmp_path, capfd):
    """A thin plate's poles of curvature at the corners of a cube take more levels than there are."""
    units = bpy.context.scene.unit_settings
    units.scale_length, units.length_unit = 0.001, "MILLIMETERS"
    cube = add("Cube", *CUBE)
    export(tmp_path / "cube.step", fit_levels=5)
    told = capfd.readouterr().out
    found = re.search(
        r"6 faces have a surface that still changes by more than the tolerance from level to level\. At most "
        r"(0\.\d+) mm off \((0\.\d+) mm is allowed\): Tolerance (0\.\d+) allows it\. Faces 0, 1, 2, 3, 4 and 5\.",
        told,
    )
    assert found, told
    off, allowed, cure = map(float, found.groups())
    assert off > 5 * allowed and allowed == pytest.approx(1e-4 * off / cure, rel=0.1)
    activate(cube)
    export(tmp_path / "cube.step", fit_levels=5, fit_tolerance=cure)
    assert "Warning" not in capfd.readouterr().out


def test_refusals(tmp_path):
    with pytest.raises(RuntimeError, match="Select a mesh or a faired surface first"):
        export("never.step")
    ball = sphere()
    with pytest.raises(RuntimeError, match="cannot be written \\(No such file"):
        export(tmp_path / "none" / "ball.step")
    ball.scale.z = 0
    with pytest.raises(RuntimeError, match="Ball: Give it a thickness. Its scale is 0 along"):
        export(tmp_path / "ball.step")
