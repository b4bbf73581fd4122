# SPDX-License-Identifier: GPL-3.0-or-later
"""The choice of energy: where it is remembered, and the report of unfinished runs."""

import bpy
from scenes import CUBE, add, computed, settings

from addon.choices import DEFAULT_ENERGY, ENERGIES
from addon.jobs.fair import Job

KEYS = [key for key, *_ in ENERGIES]
STEP = {"decrement": 0.25}


def test_files_keep_their_energy():
    properties = bpy.ops.object.fairing_surface.get_rna_type().properties
    assert properties["energy"].default == DEFAULT_ENERGY
    assert bpy.context.scene.discrete_fairing.energy == DEFAULT_ENERGY
    assert [number for *_, number in ENERGIES] == [0, 1, 2]
    assert KEYS == ["THIN_PLATE", "TOTAL_CURVATURE", "MINIMUM_VARIATION"]


def job_that_stopped(warnings=(), converged=False):
    job = computed(Job(bpy.context, add("Box", *CUBE), settings(energy="TOTAL_CURVATURE")))
    levels = [{"converged": each, "steps": [STEP]} for each in (not converged, converged)]
    job.result.report.update(curvature=levels, warnings=list(warnings))
    return job


def test_a_run_that_did_not_end_is_told():
    (sentence,) = job_that_stopped().warnings()
    assert sentence.startswith("Box: Even out the thinnest faces") and "Curvature could" in sentence
    assert job_that_stopped(converged=True).warnings() == [], "only the finest level counts"
