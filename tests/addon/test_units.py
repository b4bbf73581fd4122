# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths in the units of the scene; a list has one unit."""

from types import SimpleNamespace

import pytest

from addon.units import Units, digits_of, length_text


def scene(length_unit="METERS", system="METRIC", scale=1.0):
    told = SimpleNamespace(system=system, length_unit=length_unit, scale_length=scale)
    return SimpleNamespace(unit_settings=told)


@pytest.mark.parametrize(
    "told, length, text",
    [
        # a file of millimetres, read with no scale: the number is the one that Blender shows
        (scene(), 0.153, "0.153 m"),
        (scene(), 0.0000923, "0.0923 mm"),
        (scene("MILLIMETERS", scale=0.001), 0.153, "0.153 mm"),
        (scene("MILLIMETERS"), 0.0042, "4.2 mm"),
        (scene("ADAPTIVE"), 0.0042, "4.2 mm"),
        (scene("ADAPTIVE"), 0.153, "15.3 cm"),
        (scene("ADAPTIVE"), 0.0, "0 m"),
        (scene("ADAPTIVE", "IMPERIAL"), 0.6096, "2 ft"),
        (scene("INCHES", "IMPERIAL"), 0.6096, "24 in"),
        (scene(system="NONE"), 0.0000153, "0.0000153"),
        (scene(), 15321.25, "15321 m"),
        (scene(), float("nan"), "nan m"),
    ],
)
def test_a_length(told, length, text):
    assert length_text(told, length) == text


def test_a_list_has_one_unit():
    text = Units.of(scene("ADAPTIVE")).lengths(2.5)
    assert [text(x) for x in (2.5, 0.0421, 0.0)] == ["2.5 m", "0.0421 m", "0 m"]
    assert text(4.86e-20) == "0 m"
    finer = Units.of(scene("ADAPTIVE")).lengths(-0.0421)
    assert [finer(x) for x in (-0.0421, 0.000153)] == ["-4.21 cm", "0.0153 cm"]
    assert Units.of(scene()).volume(4.18879) == "4.19 m³"
    assert Units.of(scene("MILLIMETERS", scale=0.001)).volume(5000.0) == "5000 mm³"
    assert Units.of(scene(system="NONE")).volume(4.18879) == "4.19"
    digits = [digits_of(x) for x in (0.000153, 1.0, -12.3456, 99.96)]
    assert digits == ["0.000153", "1", "-12.3", "100"]
