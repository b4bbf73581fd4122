# SPDX-License-Identifier: GPL-3.0-or-later
"""A group or an attribute says how strongly each vertex pulls the surface."""

import bpy
import numpy as np
import pytest
from scenes import add_attribute, add_group, again, fair, moved, settings

from addon import vertex_values
from addon.errors import JobError
from addon.job import Job


def test_a_group_goes_from_nothing_to_what_holds(source):
    add_group(source, {0: 1.0, 1: 0.5, 2: 0.25, 3: 0.0}, "Pulls")
    pulls = vertex_values.pulls(source, source.data, "Pulls")
    assert pulls[0] == np.inf
    assert pulls[1:3] == pytest.approx([100, 100 / 9])
    assert not pulls[3:].any()


def test_an_attribute_is_taken_as_it_is(source):
    weights = [0.0, 0.5, 3.0, 1e6, np.inf, 1.0, 1.0, 1.0]
    add_attribute(source, weights, "Pulls")
    assert vertex_values.pulls(source, source.data, "Pulls").tolist() == weights


@pytest.mark.parametrize("wrong", [-1.0, np.nan])
def test_an_attribute_of_what_is_no_weight_is_refused(source, wrong):
    add_attribute(source, [*[1.0] * 5, wrong, 1.0, 1.0], "Pulls")
    with pytest.raises(JobError, match="at vertex 5"):
        vertex_values.pulls(source, source.data, "Pulls")


def test_a_stronger_pull_is_nearer(source):
    add_group(source, dict(enumerate([1.0, 0.9, 0.6, *[0.3] * 5])), "Pulls")
    near = {"levels": 1, "interpolation": "APPROXIMATE", "pull_group": "Pulls"}
    result = fair(tolerance=0, keep_symmetry=False, **near)
    distance = moved(source, result)
    assert distance[0] == 0
    assert 0 < distance[1] < distance[2] < distance[3:].min()
    # the tolerance holds all the same
    result = again(source, tolerance=0.01, tolerance_unit="SCENE", **near)
    assert moved(source, result).max() <= 0.01 * (1 + 1e-5)


def test_pulls_mean_nothing_with_through(source):
    job = Job(bpy.context, source, settings(pull_group="Nothing"))
    assert "weights" not in job.arguments
    with pytest.raises(JobError, match="Pull Group"):
        Job(bpy.context, source, settings(interpolation="APPROXIMATE"))
