# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface that broke is reported in words and places, although its steps have converged."""

import bmesh
import bpy
import numpy as np
import pytest
from fake_layout import draw
from scenes import CUBE, add, computed, fair, positions, recompute, settings, to_object_mode
from shapes import fish, mug

from addon.jobs.fair import Job
from addon.mesh.write import FAULTS
from addon.ui import main


def marked(target, kind):
    attribute = target.data.attributes.get(FAULTS[kind])
    return np.array([item.value for item in attribute.data]) if attribute else np.zeros(0, bool)


def test_an_inner_wall_that_breaks_through_is_told_and_its_places_can_be_selected(capfd):
    add("Mug", *mug(wall=0.1, around=12))
    target = fair(levels=2, energy="TOTAL_CURVATURE", interpolation="EXACT")
    said = capfd.readouterr().out
    assert "The surface crosses itself and bulges" in said
    assert "aise Tension" in said and "Limit or Near" in said and "Bending" in said
    crossing = marked(target, "crossing")
    radius = np.linalg.norm(positions(target.data)[crossing][:, :2], axis=1)
    assert len(radius) > 20 and radius.min() > 0.5, "where the walls are, not in the bottom"
    assert marked(target, "far").any()
    log = draw(main.VIEW3D_PT_fairing)
    assert "crosses itself" in " ".join(log) and "object.fairing_select_faults" in log
    expected = set(np.flatnonzero(crossing | marked(target, "far")).tolist())
    assert bpy.ops.object.fairing_select_faults() == {"FINISHED"}
    edit = bmesh.from_edit_mesh(target.data)
    assert {vertex.index for vertex in edit.verts if vertex.select} == expected
    to_object_mode()
    source = target.discrete_fairing.source
    source.data.attributes.new(FAULTS["far"], "BOOLEAN", "POINT")  # is not carried on
    target.discrete_fairing.energy = "THIN_PLATE"
    recompute(target)
    assert not set(FAULTS.values()) & {a.name for a in target.data.attributes}
    assert not bpy.ops.object.fairing_select_faults.poll()
    assert "object.fairing_select_faults" not in draw(main.VIEW3D_PT_fairing)


def job_of(source, **changes):
    return computed(Job(bpy.context, source, settings(**changes)))


@pytest.mark.parametrize("energy", ["THIN_PLATE", "TOTAL_CURVATURE", "MINIMUM_VARIATION"])
def test_a_sound_surface_is_not_blamed(energy):
    job = job_of(add("Box", *CUBE), energy=energy)
    assert job.faults.counts == {} and not job.warnings()


def test_limit_cures_an_inner_wall_that_breaks_through(capfd):
    add("Mug", *mug(wall=0.1, around=12))
    fair(levels=2, energy="TOTAL_CURVATURE", interpolation="LIMIT")
    assert "crosses itself" not in capfd.readouterr().out


def test_walls_of_a_fin_that_cross_are_told_though_a_sharp_valley_is_near():
    job = job_of(add("Fish", *fish()), interpolation="EXACT")
    assert job.faults.counts["crossing"] > 10
