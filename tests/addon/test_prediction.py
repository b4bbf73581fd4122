# SPDX-License-Identifier: GPL-3.0-or-later
"""Seconds that a run will take, and what is done where nobody can cancel it."""

import bpy
import numpy as np
import pytest
from fake_layout import draw
from scenes import CUBE, activate, add, fair, positions

from addon import prediction
from addon.errors import JobCancelled
from addon.job import Job
from addon.operators import fair as fairing
from addon.operators import fill
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


def test_brief_runs_say_nothing():
    prediction.note(ENERGY, 2, 0.04, "Box")
    assert prediction.seconds(ENERGY, 2, "Box") < 0.01


@pytest.mark.parametrize("text", ["", "[", "[]", '{"THIN_PLATE": 3}', '{"Other": [1]}'])
def test_what_cannot_be_read_is_nothing(text, monkeypatch):
    monkeypatch.setattr(prediction.preferences(), "speeds", text)
    assert prediction.seconds("THIN_PLATE", 10**6) > 1.0


def test_a_run_is_noted_and_the_panel_says_seconds(monkeypatch):
    source = add("Box", *CUBE)
    monkeypatch.setattr(prediction, "_BRIEF", 0.0)
    fair(levels=1)
    assert len(prediction._of_mesh) == 1
    prediction.forget()
    source.hide_set(False)
    activate(source)
    assert "768 triangles" in draw(main.VIEW3D_PT_fairing)
    job = Job(bpy.context, source, bpy.context.scene.discrete_fairing)
    prediction.note("THIN_PLATE", 768, 12.0, job._source.key)
    assert "768 triangles, about 12 s" in draw(main.VIEW3D_PT_fairing)
    assert job.predicted_seconds == pytest.approx(12.0)
    assert job.predict("THIN_PLATE", 4) == pytest.approx(48.0)


@pytest.fixture
def redo(monkeypatch):
    """As if Adjust Last Operation called."""
    monkeypatch.setattr(fairing.Fairing, "is_redone", lambda self: True)


def test_a_run_that_takes_longer_than_predicted_is_broken_off(redo, monkeypatch):
    monkeypatch.setattr(fill, "predicted_seconds", lambda jobs: 0.0)
    monkeypatch.setattr(prediction, "PATIENCE", 0.02)
    add("Box", *CUBE)
    target = fair(levels=7)
    assert len(target.data.polygons) < 6 * 4**7 and target.discrete_fairing.levels == 7
    assert [job.settings.levels for job in fill.due_jobs(bpy.context)] == [7]


def out_of_time(monkeypatch):
    """Whatever has a deadline misses it."""

    def compute(self, progress):
        raise JobCancelled(self.name)

    monkeypatch.setattr(Job, "compute", compute)


def test_where_even_a_small_surface_takes_too_long(redo, monkeypatch):
    out_of_time(monkeypatch)
    source = add("Box", *CUBE)
    source.vertex_groups.new(name="Theirs").add([0], 0.5, "REPLACE")
    source.shape_key_add(name="Basis")
    target = fair(levels=4)
    assert np.array_equal(positions(target.data), positions(source.data)), "the control mesh"
    assert source.hide_get() and target.discrete_fairing.levels == 4
    monkeypatch.undo()
    (job,) = jobs = fill.due_jobs(bpy.context)
    job.compute()
    fill.write_jobs(bpy.context, jobs)
    assert len(target.data.polygons) == 6 * 4**4
    assert [group.name for group in target.vertex_groups] == ["Theirs"]
    activate_shown(source)
    assert np.array_equal(positions(target.data), positions(fair(levels=4).data))


def test_an_old_surface_stays_until_the_new_one_is_there(redo, monkeypatch):
    add("Box", *CUBE)
    target = fair(levels=2)
    before = positions(target.data)
    target.discrete_fairing.levels = 3
    out_of_time(monkeypatch)
    assert bpy.ops.object.fairing_recompute() == {"FINISHED"}
    assert np.array_equal(positions(target.data), before)
    assert [job.target for job in fill.due_jobs(bpy.context)] == [target]


def activate_shown(source):
    source.hide_set(False)
    activate(source)


def test_redo_shows_a_small_surface_and_the_whole_one_follows(redo):
    source = add("Box", *CUBE)
    key = Job(bpy.context, source, bpy.context.scene.discrete_fairing)._source.key
    prediction.note("THIN_PLATE", 12 * 4**4, 1.0, key)  # a second at level 4
    target = fair(levels=5)
    assert len(target.data.polygons) == 6 * 4**3, "a quarter of a second"
    assert target.discrete_fairing.levels == 5
    (job,) = jobs = fill.due_jobs(bpy.context)
    job.compute()
    fill.write_jobs(bpy.context, jobs)
    assert len(target.data.polygons) == 6 * 4**5
    assert np.array_equal(positions(target.data)[:8], positions(source.data))


def test_a_slow_energy_is_stood_in_for(redo):
    source = add("Box", *CUBE)
    key = Job(bpy.context, source, bpy.context.scene.discrete_fairing)._source.key
    prediction.note(ENERGY, 12 * 4, 10.0, key)
    target = fair(levels=3, energy=ENERGY)
    assert target.discrete_fairing.energy == ENERGY and len(target.data.polygons) == 6 * 4**3
    assert fill.due_jobs(bpy.context)[0].settings.energy == ENERGY


def test_what_is_gone_or_edited_is_not_filled(redo):
    source = add("Box", *CUBE)
    key = Job(bpy.context, source, bpy.context.scene.discrete_fairing)._source.key
    prediction.note("THIN_PLATE", 12 * 4**3, 1.0, key)
    target = fair(levels=3)
    jobs = fill.due_jobs(bpy.context)
    jobs[0].compute()
    activate(target)
    bpy.ops.object.mode_set(mode="EDIT")
    fill.write_jobs(bpy.context, jobs)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(target.data.polygons) == 6 * 4**2
    bpy.data.objects.remove(target)
    assert fill.write_jobs(bpy.context, jobs) == []


def test_a_quick_redo_is_whole_at_once(redo):
    add("Box", *CUBE)
    assert len(fair(levels=3).data.polygons) == 6 * 4**3
    assert not fill._due
