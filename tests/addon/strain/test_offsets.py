# SPDX-License-Identifier: GPL-3.0-or-later
"""The example table of offsets: what is in it, the mesh that is made of it, and who is found wrong."""

import bpy
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


def test_the_three_wrong_ones_are_found_and_no_other():
    job = computed(StrainJob(bpy.context, hull()))
    assert sorted(job.result.wrong.tolist()) == sorted(WRONG)
    assert job.result.floor == pytest.approx(0.0125, rel=0.05)
    for vertex, (_, _, off) in zip(WRONG, example.WRONG, strict=True):
        assert 1000.0 * job.result.lengths[vertex] == pytest.approx(-off, abs=5.0)
