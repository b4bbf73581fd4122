# SPDX-License-Identifier: GPL-3.0-or-later
"""The choice of energy: what it makes, where it is remembered, what is said of unfinished runs."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from scenes import CUBE, activate, add, fair, positions

from addon import core, prediction
from addon.choices import DEFAULT_ENERGY, ENERGIES
from addon.inspection import measures
from addon.job import Job
from addon.memory import recall
from addon.mesh.read import read_mesh
from addon.operators import fair as fair_operators
from addon.settings import Settings

KEYS = [key for key, *_ in ENERGIES]
STEP = {"decrement": 0.25}


def radii(target):
    return np.linalg.norm(positions(target.data), axis=1)


def again(source, **settings):
    source.hide_set(False)
    activate(source)
    return fair(**settings)


def add_with_key():
    source = add("Box", *CUBE)
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Up").data[0].co.z += 1.0
    return source


def test_one_default_everywhere():
    properties = bpy.ops.object.fairing_surface.get_rna_type().properties
    assert properties["energy"].default == DEFAULT_ENERGY
    assert bpy.context.scene.discrete_fairing.energy == DEFAULT_ENERGY
    assert bpy.data.objects.new("New", None).discrete_fairing.energy == DEFAULT_ENERGY


def test_files_keep_their_energy():
    assert [number for *_, number in ENERGIES] == [0, 1, 2]
    assert KEYS == ["THIN_PLATE", "TOTAL_CURVATURE", "MINIMUM_VARIATION"]


def test_a_cube_becomes_a_sphere_by_total_curvature_only():
    source = add("Box", *CUBE)
    assert np.ptp(radii(fair(levels=3, energy="TOTAL_CURVATURE"))) < 1e-5
    assert np.ptp(radii(again(source, levels=3, energy="THIN_PLATE"))) > 0.1


def test_report_has_the_steps():
    source = add("Box", *CUBE)
    report = recall(fair(levels=2, energy="TOTAL_CURVATURE"), "report")
    assert core.has_converged(report)
    assert core.step_count(report) >= 1 and 0 <= core.last_decrement(report) < 1
    report = recall(again(source, levels=2, energy="THIN_PLATE"), "report")
    assert core.has_converged(report)
    assert core.step_count(report) is None and core.last_decrement(report) is None


@pytest.mark.parametrize("report", [{}, {"curvature": []}])
def test_no_steps_are_no_fault(report):
    assert core.has_converged(report) and core.last_decrement(report) is None


def test_a_flat_surface_needs_no_step():
    report = {"curvature": [{"converged": True, "steps": []}]}
    assert core.step_count(report) == 0 and core.last_decrement(report) is None


def job_that_stopped(warnings=(), converged=False):
    job = Job(bpy.context, add("Box", *CUBE), Settings.of(bpy.context.scene.discrete_fairing))
    job.settings = replace(job.settings, energy="TOTAL_CURVATURE")
    job.compute()
    levels = [
        {"converged": not converged, "steps": [STEP]},
        {"converged": converged, "steps": [STEP]},
    ]
    job.result.report.update(curvature=levels, warnings=list(warnings))
    return job


def test_a_run_that_did_not_end_is_told():
    (sentence,) = job_that_stopped().warnings()
    assert sentence.startswith("Box: Even out the thinnest faces") and "Curvature could" in sentence
    assert "1 times as long as high" in sentence and "fold has 90°" in sentence
    assert "very thin" not in sentence, "of even faces"


def test_the_thinnest_face_is_named():
    points = [(0, 0, 0), (4, 0, 0), (4, 1, 0), (0, 1, 0), (8, 0, 0), (4, 0, 0)]
    sheet = add("Sheet", points, [(0, 1, 2, 3), (1, 4, 2), (1, 5, 4)])
    face, ratio = measures.thinnest_face(read_mesh(sheet.data))
    assert face == 1 and ratio == pytest.approx(17 / 4), "the last has no area"
    empty = measures.thinnest_face(read_mesh(add("Nothing", [], []).data))
    assert empty == (-1, 0.0)


def test_only_the_finest_level_counts():
    assert job_that_stopped(converged=True).warnings() == []


def test_it_is_told_once():
    said = {
        "code": "NOT_CONVERGED",
        "message": "The solver stopped.",
        "elements": [],
        "kind": "mesh",
    }
    (sentence,) = job_that_stopped([said]).warnings()
    assert sentence.startswith("Box: Use fewer levels") and "solver" not in sentence
    other = said | {"code": "ISOLATED_VERTICES"}
    assert len(job_that_stopped([other]).warnings()) == 2


def test_a_note_says_that_shape_keys_only_blend(capfd):
    source = add_with_key()
    assert len(fair(levels=1, energy="TOTAL_CURVATURE").data.shape_keys.key_blocks) == 2
    assert "Each shape key is faired separately" in capfd.readouterr().out
    again(source, levels=1, energy="THIN_PLATE")
    again(source, levels=1, energy="TOTAL_CURVATURE", use_shape_keys=False)
    again(add("Plain", *CUBE), levels=1, energy="TOTAL_CURVATURE")
    assert "shape key" not in capfd.readouterr().out


@pytest.mark.parametrize("energy", KEYS)
def test_slower_energies_get_their_bar_earlier(energy, monkeypatch):
    add("Box", *CUBE)
    started = []
    fake = type(
        "Fake",
        (fair_operators.Fairing,),
        {"_prepare": lambda self, context: [job], "_block": lambda *_: "blocked"},
    )
    fake.start = lambda self, context, jobs: started.append(jobs) or "started"
    job = type("J", (), {"predicted_seconds": prediction._AT_FIRST[energy] * 768, "result": None})
    answer = fake().invoke(bpy.context, None)
    assert answer == ("started" if energy == "MINIMUM_VARIATION" else "blocked")
