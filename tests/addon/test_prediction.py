# SPDX-License-Identifier: GPL-3.0-or-later
"""The predicted seconds of a run, and what happens where nobody can cancel it."""

import bpy
import numpy as np
import pytest
from fake_layout import draw
from scenes import CUBE, activate, add, fair, positions, refused, settings

from addon import prediction
from addon.errors import JobCancelled
from addon.jobs.fair import Job
from addon.live.pace import Deadline
from addon.operators import fair as fairing
from addon.operators import modal as redoing
from addon.surfaces.freshness import UNFINISHED, why_stale
from addon.ui import main

ENERGY = "TOTAL_CURVATURE"


def test_the_last_runs_count_by_energy():
    before = prediction.seconds("THIN_PLATE", 1000)
    prediction.note(ENERGY, 1000, 3.0, "Box")
    assert prediction.seconds(ENERGY, 2000) == pytest.approx(6.0)
    assert prediction.seconds("THIN_PLATE", 1000) == before
    for _ in range(prediction._KEPT):
        prediction.note(ENERGY, 1000, 1.0, "Ball")
    assert prediction.seconds(ENERGY, 1000) == pytest.approx(1.0), "what is long ago is forgotten"
    assert prediction.seconds(ENERGY, 1000, "Box") == pytest.approx(3.0), "its own runs say more"


def test_a_run_is_noted_and_the_panel_says_seconds(source, monkeypatch):
    monkeypatch.setattr(prediction, "_BRIEF", 0.0)
    fair(levels=1)
    assert len(prediction._of_mesh) == 1
    prediction.forget()
    source.hide_set(False)
    activate(source)
    assert "768 triangles" in draw(main.VIEW3D_PT_fairing)
    job = Job(bpy.context, source, settings())
    prediction.note("THIN_PLATE", 768, 12.0, job.reference.key)
    assert "768 triangles, about 12 s" in draw(main.VIEW3D_PT_fairing)
    assert job.predicted_seconds == pytest.approx(12.0)
    assert job.predict("THIN_PLATE", 4) == pytest.approx(48.0)


@pytest.fixture
def redo(monkeypatch):
    """Runs as Adjust Last Operation does; no run is late, however busy the machine is."""
    monkeypatch.setattr(fairing.Fairing, "is_redone", lambda self: True)
    monkeypatch.setattr(fairing, "Deadline", lambda seconds: None)


def by_its_button(operator):
    """Completes a surface that is shown with fewer levels."""
    assert why_stale(bpy.context.active_object) == UNFINISHED
    assert operator() == {"FINISHED"}
    assert why_stale(bpy.context.active_object) == ""


def test_a_run_that_takes_longer_than_predicted_is_broken_off(redo, monkeypatch):
    monkeypatch.setattr(redoing, "predicted_seconds", lambda jobs: 0.0)
    monkeypatch.setattr(prediction, "PATIENCE", 0.02)
    monkeypatch.setattr(fairing, "Deadline", lambda s: Deadline(s) if s == 0.02 else None)
    add("Box", *CUBE)
    target = fair(levels=7)
    assert len(target.data.polygons) < 6 * 4**7 and target.discrete_fairing.levels == 7
    assert why_stale(target) == UNFINISHED


def test_where_even_a_small_surface_takes_too_long(redo, monkeypatch):
    """Nothing is made, so Blender puts back what was there."""

    def compute(self, **_):
        raise JobCancelled(self.name)

    monkeypatch.setattr(Job, "compute", compute)
    add("Box", *CUBE)
    refused("set it in the panel, and press Recompute", bpy.ops.object.fairing_surface, levels=4)
    assert [o.name for o in bpy.data.objects] == ["Box"]


def test_redo_shows_a_small_surface_and_recompute_the_whole_one(source, redo, monkeypatch):
    key = Job(bpy.context, source, settings()).reference.key
    prediction.note("THIN_PLATE", 12 * 4**4, 1.0, key)  # a second at level 4
    target = fair(levels=5)
    assert len(target.data.polygons) == 6 * 4**3, "a quarter of a second"
    assert target.discrete_fairing.levels == 5
    monkeypatch.undo()
    by_its_button(bpy.ops.object.fairing_recompute)
    assert len(target.data.polygons) == 6 * 4**5
    assert np.array_equal(positions(target.data)[:8], positions(source.data))


def test_a_slow_energy_is_stood_in_for(source, redo, monkeypatch):
    key = Job(bpy.context, source, settings()).reference.key
    prediction.note(ENERGY, 12 * 4, 10.0, key)
    target = fair(levels=3, energy=ENERGY)
    assert target.discrete_fairing.energy == ENERGY and len(target.data.polygons) == 6 * 4**3
    bent = positions(target.data)
    monkeypatch.undo()
    by_its_button(bpy.ops.object.fairing_recompute_stale)
    assert np.abs(positions(target.data) - bent).max() > 1e-3
