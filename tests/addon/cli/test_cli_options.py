# SPDX-License-Identifier: GPL-3.0-or-later
"""The options follow the settings, and a vertex may have its own tolerance."""

from dataclasses import asdict

import pytest

from addon.cli import options
from addon.cli.options import parser
from addon.settings import NAMES


def settings(*words):
    return options.settings_of(parser("").parse_intermixed_args(["in.obj", "out.obj", *words]))


def test_every_other_setting_can_be_said():
    words = parser("").format_help()
    assert set(NAMES) >= options.NOT_HERE
    assert "--tolerance-unit" not in words, "said with the tolerance"
    for name in set(NAMES) - options.NOT_HERE - {"tolerance_unit"}:
        assert options.option(name) + " " in words or options.option(name) + "," in words, name
    for name in options.NOT_HERE:
        assert options.option(name) + " " not in words, name


def test_defaults_are_those_of_blender(blender):
    defaults = blender.context.scene.discrete_fairing
    for name, value in asdict(settings()).items():
        assert value == pytest.approx(getattr(defaults, name)), name


def test_a_value_switches_its_rule_on():
    assert not settings().use_crease_angle
    assert settings("--crease-angle", "40").use_crease_angle
    assert settings("--corner-angle", "180").corner_angle == pytest.approx(3.14159265)
    assert settings("--shade-smooth").shade_smooth
    assert not settings("--shade-smooth", "--no-shade-smooth").shade_smooth


@pytest.mark.parametrize(
    "option, value, unit",
    [
        ("--tolerance", "0.1", "SCENE"),
        ("--tolerance", "10%", "RELATIVE"),
        ("--tolerance-group", "Loose", "RELATIVE"),
    ],
)
def test_a_tolerance_needs_no_second_option(option, value, unit):
    given = settings(option, value)
    assert (given.interpolation, given.tolerance_unit) == ("APPROXIMATE", unit)
    assert option != "--tolerance" or given.tolerance == 0.1
    with pytest.raises(ValueError, match=f"{option} needs --interpolation approximate"):
        settings("--interpolation", "exact", option, value)


def test_a_share_of_the_way_to_the_limit_says_that_it_is_meant():
    given = settings("--limit", "0.5")
    assert (given.interpolation, given.limit) == ("LIMIT", 0.5)
    assert settings("--interpolation", "limit").limit == 1.0
    with pytest.raises(ValueError, match="--limit needs --interpolation limit"):
        settings("--interpolation", "exact", "--limit", "0.5")


@pytest.mark.parametrize("number", ["nan", "inf", "-1", "x", "%", "-1%"])
def test_no_number_out_of_range_passes(number):
    with pytest.raises(SystemExit):
        settings("--tolerance", number)
