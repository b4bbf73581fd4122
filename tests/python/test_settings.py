# SPDX-License-Identifier: GPL-3.0-or-later
"""The package's settings are those of the core."""

import inspect
from typing import get_args, get_type_hints

import discrete_fairing as df
import numpy as np
import pytest
from discrete_fairing import _native
from discrete_fairing.options import ONE_A_VERTEX, OPTIONAL, SETTINGS, AllSettings, native_options


def test_the_core_has_every_setting():
    members = {name for name in dir(_native.Options) if not name.startswith("_")}
    assert members == set(SETTINGS)


def test_arguments_by_place_have_the_defaults_of_the_core():
    parameters, core = inspect.signature(df.fair).parameters, _native.Options()
    assert parameters["levels"].default == core.levels
    assert parameters["energy"].default == core.energy.name


def test_choices_are_those_of_the_core():
    checked = 0
    for name, hint in get_type_hints(AllSettings).items():
        core = getattr(_native.Options(), name)
        if not hasattr(type(core), "__members__"):
            continue
        plain = [arg for arg in (hint, *get_args(hint)) if isinstance(arg, str)]
        listed = plain or [value for arg in get_args(hint) for value in get_args(arg)]
        more = {"auto"} if name == "interpolation" else set()  # decided before the core sees it
        assert set(listed) == set(type(core).__members__) | more, name
        checked += 1
    assert checked == 7


def test_what_may_be_none_is_the_default_then():
    for name in OPTIONAL:
        assert getattr(native_options({name: None}), name) == getattr(_native.Options(), name)
    with pytest.raises(df.FairingError, match="chart is None"):
        native_options({"chart": None})


@pytest.mark.parametrize("values", (np.ones(3), [1.0, 1.0, 1.0, -0.5], [1.0, 1.0, 1.0, np.nan]))
@pytest.mark.parametrize("name", ONE_A_VERTEX)
def test_one_number_a_vertex_is_checked_by_the_core(name, values):
    square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    with pytest.raises(df.FairingError, match=f"^{name} (has 3 entries|must be)") as caught:
        df.fair(square, [(0, 1, 2, 3)], **{name: values})
    assert caught.value.code == "BAD_OPTION"
    assert caught.value.elements == ([3] if len(values) == 4 else [])


def test_a_name_that_is_no_setting_is_refused():
    with pytest.raises(TypeError, match="'padsize' is not a setting; do you mean pad_size"):
        df.fair([[0, 0, 0]], [], padsize=1.0)
    with pytest.raises(
        TypeError, match="'qwxz' is not a setting; the settings are metric_exponent,"
    ):
        df.fair([[0, 0, 0]], [], qwxz=1.0)


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
    assert native_options(given).interpolation.name == interpolation
