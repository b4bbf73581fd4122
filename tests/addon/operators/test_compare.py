# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare: one click, and the energies stand side by side with their figures."""

import bpy
import numpy as np
import pytest
from scenes import CUBE, add, again, positions

from addon.memory import recall
from addon.operators import compare as operator

NAMES = ["Box Bending", "Box Curvature", "Box Flow Lines"]


def compared(**settings):
    for name, value in {"levels": 2, **settings}.items():
        setattr(bpy.context.scene.discrete_fairing, name, value)
    assert bpy.ops.object.fairing_compare() == {"FINISHED"}
    return [bpy.data.objects[name] for name in NAMES]


def test_the_energies_stand_in_a_row(source):
    source.location = (1, 2, 3)
    made = compared()
    assert {o.name for o in bpy.context.selected_objects} == set(NAMES)
    places = [tuple(o.matrix_world.translation) for o in made]
    assert np.allclose(places, [(1 + 2.3 * k, 2, 3) for k in (1, 2, 3)])
    assert source.visible_get() and all(o.show_name for o in made)
    for target, energy in zip(made, ("THIN_PLATE", "TOTAL_CURVATURE", "MINIMUM_VARIATION")):
        assert target.discrete_fairing.energy == energy and target.discrete_fairing.levels == 2
        alone = again(source, energy=energy, levels=2)
        assert np.array_equal(positions(target.data), positions(alone.data))


def test_each_is_measured():
    add("Box", *CUBE)
    made = compared()
    found = [recall(target, "readout")["after"]["total_curvature"] for target in made]
    assert found[1] == pytest.approx(min(found), rel=1e-3), "the one that has the least of it"


def test_large_surfaces_wait_for_measure(monkeypatch):
    monkeypatch.setattr(operator, "MEASURED", 10)
    add("Box", *CUBE)
    compared()
    assert not any(recall(bpy.data.objects[name], "readout") for name in NAMES)
