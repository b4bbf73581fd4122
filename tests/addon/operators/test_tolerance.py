# SPDX-License-Identifier: GPL-3.0-or-later
"""Near: tolerances, their groups and pulls."""

import bpy
import numpy as np
import pytest
from live_scenes import follow, live, pull, session, whole
from scenes import CUBE, add, add_attribute, add_group, again, fair, moved, positions, settings

from addon import vertex_values
from addon.errors import JobError
from addon.jobs.fair import Job


def test_a_drag_does_not_change_what_the_tolerance_is_a_share_of(source, no_pause):
    """Otherwise each update would build a solver."""
    target = fair(levels=2, interpolation="APPROXIMATE")
    target.discrete_fairing_live.levels = 1
    live(target)
    pull(source)
    solver = session(target).made.solver
    pull(source)
    assert session(target).made.solver is solver
    whole(target)
    fresh = session(target).made.solver
    assert fresh is not solver
    pull(source)
    assert session(target).made.solver is fresh


# --- a group


LOOSE = {"levels": 1, "interpolation": "APPROXIMATE", "tolerance_group": "Loose"}


def loose_by_group(source):
    add_group(source, {0: 1.0, 1: 0.5})


def loose_by_attribute(source):
    add_attribute(source, [1.0, 0.5, *[0.0] * 6])


@pytest.mark.parametrize("make", [loose_by_group, loose_by_attribute])
@pytest.mark.parametrize("settings", [{}, {"mesh_source": "EVALUATED"}])
def test_a_group_says_where_the_surface_may_miss(source, make, settings):
    make(source)
    result = fair(tolerance=0.05, **LOOSE, **settings)
    distance = moved(source, result)
    assert 0.05 < distance[0] <= 0.1 * (1 + 1e-5) and 0 < distance[1] <= 0.05 * (1 + 1e-5)
    assert np.array_equal(positions(result.data)[2:8], positions(source.data)[2:])


def test_live_waits_for_a_group_that_is_gone(source):
    target = fair(levels=1, interpolation="APPROXIMATE")
    live(target)
    target.discrete_fairing.tolerance_group = "Loose"
    target.update_tag()
    follow()
    assert "named 'Loose'" in session(target).trouble
    target.discrete_fairing.tolerance_group = ""
    target.update_tag()
    follow()
    assert not session(target).trouble
    assert source.vertex_groups.get("Loose") is None


def test_a_name_that_is_nothing_is_refused():
    add("Box", *CUBE)
    with pytest.raises(RuntimeError, match="Box: Choose another Tolerance Group.*named 'Loose'"):
        fair(interpolation="APPROXIMATE", tolerance_group="Loose")
    assert len(bpy.data.objects) == 1


def test_values_are_from_nothing_to_all(source):
    add_attribute(source, [-1.0, 0.25, 2.0, *[0.5] * 5])
    found = vertex_values.factors(source, source.data, "Loose")
    assert found.tolist() == [0.0, 0.25, 1.0, *[0.5] * 5]
    add_group(source, {3: 0.75})
    found = vertex_values.factors(source, source.data, "Loose")
    assert found.tolist() == [0, 0, 0, 0.75, 0, 0, 0, 0], "the group, of two with one name"


@pytest.mark.parametrize("how", ["EXEC_DEFAULT", "INVOKE_DEFAULT"])
@pytest.mark.parametrize(
    "given, vertices",
    [
        ({"tolerance": 0.05}, "APPROXIMATE"),
        ({"tolerance": 0.05, "limit": 0.5}, "APPROXIMATE"),
        ({"limit": 0.5}, "LIMIT"),
        ({"tolerance": 0.05, "interpolation": "EXACT"}, "EXACT"),
        ({}, "EXACT"),
    ],
)
def test_a_tolerance_that_is_given_means_near(how, given, vertices):
    add("Box", *CUBE)
    assert bpy.ops.object.fairing_surface(how, levels=1, **given) == {"FINISHED"}
    made = bpy.context.active_object
    assert made.discrete_fairing.interpolation == vertices
    off = np.linalg.norm(positions(made.data)[:8] - CUBE[0], axis=1).max()
    assert (off > 0.01) == (vertices != "EXACT")
    if "tolerance" in given and vertices == "APPROXIMATE":
        assert off <= 0.1 + 1e-6
        add("Crate", *CUBE)
        bpy.ops.object.fairing_surface(how, levels=1)
        again = bpy.context.active_object.discrete_fairing
        assert again.interpolation == "EXACT", "the last tolerance is not given again"


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
    result = fair(tolerance=0, **near)
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
