# SPDX-License-Identifier: GPL-3.0-or-later
"""Shipped presets, for the panel and for the redo panel, and the user's own."""

import ast
from pathlib import Path

import bpy
import pytest
from scenes import CUBE, add, fair

import addon
from addon.settings.presets import VIEW3D_PT_fairing_presets
from addon.settings.properties import NAMES

FOLDER = Path(addon.__file__).parent / "presets"
SHIPPED = ("organic", "hull", "mechanical_with_creases")


def values(folder, name):
    """What a preset file assigns, {setting: value}; read, not run."""
    tree = ast.parse((FOLDER / folder / f"{name}.py").read_text())
    return {
        node.targets[0].attr: ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute)
    }


@pytest.mark.parametrize("name", SHIPPED)
def test_both_menus_ship_the_same(name):
    panel = values("discrete_fairing", name)
    assert panel == values("operator/object.fair_surface", name)
    assert set(panel) <= set(NAMES) and "energy" in panel


def test_blender_finds_them():
    paths = [Path(path) for path in bpy.utils.preset_paths("discrete_fairing")]
    found = {file.stem for path in paths for file in path.glob("*.py")}
    assert set(SHIPPED) <= found


@pytest.mark.parametrize("name", SHIPPED)
def test_menu_applies_them(name):
    given = values("discrete_fairing", name)
    bpy.ops.script.execute_preset(
        filepath=str(FOLDER / "discrete_fairing" / f"{name}.py"),
        menu_idname=VIEW3D_PT_fairing_presets.__name__,
    )
    settings = bpy.context.scene.discrete_fairing
    for key, value in given.items():
        expected = pytest.approx(value) if isinstance(value, float) else value
        assert getattr(settings, key) == expected, key
    add("Box", *CUBE)
    fair(**{**{key: getattr(settings, key) for key in NAMES}, "levels": 1})


def test_own_preset(tmp_path, monkeypatch):
    monkeypatch.setattr(bpy.utils, "user_resource", lambda *_, path="", **__: str(tmp_path))
    bpy.context.scene.discrete_fairing.metric_exponent = 0.25
    assert bpy.ops.object.fairing_preset_add(name="Mine") == {"FINISHED"}
    text = (tmp_path / "Mine.py").read_text()
    assert "settings.metric_exponent = 0.25" in text and "use_selection" not in text
