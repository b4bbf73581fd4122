# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of settings stands in fair()'s signature, in the package and in the core: one list."""

import inspect

import discrete_fairing as df
import pytest
from discrete_fairing import _native
from discrete_fairing.options import OPTIONAL, SETTINGS, native_options

OTHER_ARGUMENTS = {
    *("vertices", "faces", "shapes", "symmetry_plane", "strain", "progress", "monitor"),
}
PARAMETERS = inspect.signature(df.fair).parameters


def test_fair_takes_every_setting():
    assert set(PARAMETERS) - OTHER_ARGUMENTS == set(SETTINGS)


def test_the_core_has_every_setting():
    members = {name for name in dir(_native.Options) if not name.startswith("_")}
    assert members == set(SETTINGS)


def test_defaults_are_those_of_the_core():
    ours = {name: PARAMETERS[name].default for name in SETTINGS}
    assert {name for name, default in ours.items() if default is None} == set(OPTIONAL)
    passed, core = native_options(**ours), _native.Options()
    for name in SETTINGS:
        assert getattr(passed, name) == getattr(core, name), name


@pytest.mark.parametrize(
    "given, interpolation",
    [
        ({}, "exact"),
        ({"tolerance": 0.0}, "exact"),
        ({"tolerance": 0.05}, "approximate"),
        ({"tolerance": [0.0, 0.05, 0.0]}, "approximate"),
        ({"weights": [1.0, 2.0, 3.0]}, "approximate"),
        ({"tolerance": 0.05, "interpolation": "exact"}, "exact"),
        ({"tolerance": 0.05, "interpolation": None}, "approximate"),
        ({"interpolation": "limit"}, "limit"),
    ],
)
def test_a_tolerance_that_is_given_says_that_vertices_may_be_missed(given, interpolation):
    assert native_options(**given).interpolation.name == interpolation
