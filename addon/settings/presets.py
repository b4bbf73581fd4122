# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of the panel, through Blender's own machinery: shipped ones lie in addon/presets, the user's in their own folder."""

from pathlib import Path

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from .properties import NAMES

_FOLDER = str(Path(__file__).resolve().parent.parent)  # the one that holds presets/
_SUBFOLDER = "discrete_fairing"
# belongs to the work at hand, not to the kind of thing that is made
_NOT_KEPT = {"use_selection", "memory_limit"}


class VIEW3D_PT_fairing_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Fairing Presets"
    preset_subdir = _SUBFOLDER
    preset_operator = "script.execute_preset"
    preset_add_operator = "object.fairing_preset_add"


class OBJECT_OT_fairing_preset_add(AddPresetBase, bpy.types.Operator):
    """Keep the settings of the panel under a name, or remove a name"""

    bl_idname = "object.fairing_preset_add"
    bl_label = "Add Fairing Preset"
    preset_menu = "VIEW3D_PT_fairing_presets"
    preset_subdir = _SUBFOLDER
    preset_defines = ["settings = bpy.context.scene.discrete_fairing"]
    preset_values = [f"settings.{name}" for name in NAMES if name not in _NOT_KEPT]


def draw_presets(layout):
    """The menu of presets, in a panel's header."""
    VIEW3D_PT_fairing_presets.draw_panel_header(layout)


CLASSES = (OBJECT_OT_fairing_preset_add, VIEW3D_PT_fairing_presets)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(CLASSES)


def register():
    _register_classes()
    bpy.utils.register_preset_path(_FOLDER)


def unregister():
    bpy.utils.unregister_preset_path(_FOLDER)
    _unregister_classes()
