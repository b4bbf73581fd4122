# SPDX-License-Identifier: GPL-3.0-or-later
"""Shipped presets, for the panel and for the redo panel, and the user's own."""

from pathlib import Path

import bpy
import pytest
from scenes import CUBE, add, fair

import addon
from addon.operators.presets import NOT_KEPT
from addon.purposes import PRESET_FOLDER, preset_values
from addon.settings import NAMES

FOLDER = Path(addon.__file__).parent / "presets" / PRESET_FOLDER
SHIPPED = ("Default", "Character", "Hull", "Mechanical", "Panel", "Points")


def values(name):
    return preset_values(FOLDER / f"{name}.py")


def same(settings, given):
    for key, value in given.items():
        expected = pytest.approx(value) if isinstance(value, float) else value
        assert getattr(settings, key) == expected, key


@pytest.mark.parametrize("name", SHIPPED)
def test_menu_applies_them(name):
    given, settings = values(name), bpy.context.scene.discrete_fairing
    assert list(given) == [name for name in NAMES if name not in NOT_KEPT], "all, in their order"
    if name == "Default":
        same(settings, given)  # those of a new file
    bpy.ops.object.fairing_preset_apply(filepath=str(FOLDER / f"{name}.py"))
    same(settings, given)
    add("Box", *CUBE)
    target = fair(**{**{key: getattr(settings, key) for key in NAMES}, "levels": 1})
    settings.levels = 5
    bpy.ops.object.fairing_preset_apply(filepath=str(FOLDER / "Character.py"))
    assert target.discrete_fairing.interpolation == "LIMIT", "of the surface that is active"
    assert settings.levels == 5


def test_own_preset(tmp_path, monkeypatch):
    monkeypatch.setattr(bpy.utils, "user_resource", lambda *_, path="", **__: str(tmp_path))
    settings = bpy.context.scene.discrete_fairing
    settings.metric_exponent = 0.25
    assert bpy.ops.object.fairing_preset_add(name="Mine") == {"FINISHED"}
    text = (tmp_path / "Mine.py").read_text()
    assert "op.metric_exponent = 0.25" in text and "use_selection" not in text
    settings.metric_exponent = 1.0
    bpy.ops.object.fairing_preset_apply(filepath=str(tmp_path / "Mine.py"))
    assert settings.metric_exponent == 0.25
