# SPDX-License-Identifier: GPL-3.0-or-later
"""The example table of offsets: what is in it, the mesh that is made of it, and who is found wrong."""

import bpy
import numpy as np
import offsets as example
import pytest
from scenes import computed

from addon.strain.measure import StrainJob

WRONG = [station * len(example.LINES) + line for station, line, _ in example.WRONG]


def hull():
    example.add_to_scene()
    source = bpy.data.objects["Offsets"]
    bpy.context.view_layer.objects.active = source
    bpy.context.scene.discrete_fairing.symmetry_plane = "Y"
    return source


def test_the_table_is_the_hull_as_it_was_measured():
    off = 1000.0 * example.read() - example.fair_hull()
    assert off.shape == (11, 9, 3) and not off[:, 0, 1].any()
    assert np.abs(off[:, :, 0]).max() < 1e-6, "stations are where they are"
    size = np.linalg.norm(off, axis=2).ravel()
    assert size[WRONG] == pytest.approx(18.0, abs=6.0)
    others = np.delete(off[:, :, 1:].reshape(-1, 2), WRONG, axis=0)
    assert np.sqrt(np.mean(others**2)) == pytest.approx(example.SCATTER, rel=0.15)


def test_it_can_be_written_anew(tmp_path):
    example.write(tmp_path / "offsets.csv", example.taken_off(example.fair_hull()))
    assert (tmp_path / "offsets.csv").read_bytes() == example.TABLE.read_bytes()


def test_the_three_wrong_ones_are_found_and_no_other():
    job = computed(StrainJob(bpy.context, hull()))
    assert sorted(job.result.wrong.tolist()) == sorted(WRONG)
    assert job.result.floor == pytest.approx(0.0125, rel=0.05)
    for vertex, (_, _, off) in zip(WRONG, example.WRONG, strict=True):
        assert 1000.0 * job.result.lengths[vertex] == pytest.approx(-off, abs=5.0)
