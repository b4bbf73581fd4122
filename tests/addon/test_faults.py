# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that broke say so, in words and places, although their steps have converged."""

import bmesh
import bpy
import numpy as np
import pytest
from fake_layout import draw
from scenes import CUBE, add, add_suzanne, fair, positions
from shapes import mug

from addon.check import faults, folds
from addon.job import Job
from addon.mesh.write import FAULTS
from addon.settings import Settings
from addon.transfer.coarse import coarse_triangles
from addon.ui import main


def marked(target, kind):
    attribute = target.data.attributes.get(FAULTS[kind])
    return np.array([item.value for item in attribute.data]) if attribute else np.zeros(0, bool)


def computed(source, **settings):
    panel = bpy.context.scene.discrete_fairing
    for name, value in settings.items():
        setattr(panel, name, value)
    job = Job(bpy.context, source, Settings.of(panel))
    job.compute()
    return job


def test_an_inner_wall_that_breaks_through_is_told(capfd):
    add("Mug", *mug(wall=0.1, around=12))
    target = fair(levels=2, energy="TOTAL_CURVATURE")
    said = capfd.readouterr().out
    assert "The surface crosses itself and bulges" in said
    assert "aise Tension" in said and "Near" in said and "Bending" in said
    crossing = marked(target, "crossing")
    radius = np.linalg.norm(positions(target.data)[crossing][:, :2], axis=1)
    assert len(radius) > 20 and radius.min() > 0.5, "where the walls are, not in the bottom"
    assert marked(target, "far").any()


def test_the_places_can_be_selected():
    add("Mug", *mug(wall=0.1, around=12))
    target = fair(levels=2, energy="TOTAL_CURVATURE")
    log = draw(main.VIEW3D_PT_fairing)
    assert "crosses itself" in " ".join(log) and "object.fairing_select_faults" in log
    expected = set(np.flatnonzero(marked(target, "crossing") | marked(target, "far")).tolist())
    assert bpy.ops.object.fairing_select_faults() == {"FINISHED"}
    edit = bmesh.from_edit_mesh(target.data)
    assert {vertex.index for vertex in edit.verts if vertex.select} == expected
    bpy.ops.object.mode_set(mode="OBJECT")
    target.discrete_fairing.energy = "THIN_PLATE"
    bpy.ops.object.fairing_recompute()
    assert not set(FAULTS.values()) & {a.name for a in target.data.attributes}
    assert not bpy.ops.object.fairing_select_faults.poll()
    assert "object.fairing_select_faults" not in draw(main.VIEW3D_PT_fairing)


@pytest.mark.parametrize("energy", ["THIN_PLATE", "TOTAL_CURVATURE", "MINIMUM_VARIATION"])
def test_a_sound_surface_is_not_blamed(energy):
    job = computed(add("Box", *CUBE), energy=energy)
    assert job.faults.counts == {} and not job.warnings()


def test_suzanne_is_not_blamed_for_what_her_mesh_does():
    """Her eyes stand in her head, and her nostrils are folded over."""
    assert computed(add_suzanne(), levels=3).faults.counts == {}


@pytest.mark.parametrize("most", [500, 3000, 40_000])
def test_fine_surfaces_are_looked_at_by_fewer_points(most, monkeypatch):
    job = computed(add("Mug", *mug(wall=0.07)), energy="TOTAL_CURVATURE", levels=2)
    monkeypatch.setattr(faults, "MOST", most)
    found = faults.find_faults(job.result, job.transfer, job.arrays)
    assert job.transfer.triangle_count == 1536 and found.counts["crossing"] > 20
    plain = computed(add("Thin", *mug(wall=0.07)), energy="THIN_PLATE", levels=3)
    assert faults.find_faults(plain.result, plain.transfer, plain.arrays).counts == {}


def test_a_coarse_lattice_is_part_of_the_fine_one():
    job = computed(add("Box", *CUBE), levels=3)
    triangles, owner = coarse_triangles(job.transfer, 0)
    assert len(triangles) == 12 and np.array_equal(np.unique(triangles), np.arange(8))
    assert np.array_equal(np.bincount(owner), [2] * 6)
    finest, _ = coarse_triangles(job.transfer, 3)
    assert {tuple(sorted(t)) for t in finest.tolist()} >= {
        tuple(sorted(t)) for t in job.result.faces[1][:, :3].tolist()
    }
    middle, owner = coarse_triangles(job.transfer, 1)
    assert len(middle) == 48 and len(np.unique(middle)) == 6 * 4 + 2


def test_folds_of_the_report_have_places():
    fold = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.1, 0.9, 0.1)], float)
    folded = folds.folded(fold, np.array([(0, 1, 2), (0, 2, 3), (2, 1, 3)]))
    assert folded.any() and not folds.folded(fold, np.array([(0, 1, 2)])).any()


def test_places_are_not_carried_on():
    source = add("Box", *CUBE)
    source.data.attributes.new(FAULTS["far"], "BOOLEAN", "POINT")
    assert FAULTS["far"] not in fair(levels=1).data.attributes
