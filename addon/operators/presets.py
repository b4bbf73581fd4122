# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets by Blender's own machinery: shipped ones are in addon/presets, the user's in their own
folder.

A preset is a script that sets the active operator's properties, like those of Blender's redo panel. The
panel runs and saves the same scripts with its settings in place of the operator.
"""

from typing import Any, cast

import bpy
from bl_operators.presets import AddPresetBase

from ..blender import Answer, Context
from ..fields import text
from ..purposes import FOLDER, PRESET_FOLDER
from ..settings import NAMES
from ..ui.active import active_settings

_FOLDER = str(FOLDER.parent)  # contains presets/
# settings of the present work, not of a kind of object
NOT_KEPT = {"use_selection", "tolerance_group", "pull_group", "symmetry_plane"}


def _settings_as_operator(context: Context) -> Any:
    return context.temp_override(active_operator=active_settings(context))


class OBJECT_OT_fairing_preset_apply(bpy.types.Operator):
    """Apply the settings of this preset"""

    bl_idname = "object.fairing_preset_apply"
    bl_label = "Apply Fairing Preset"
    bl_options = {"INTERNAL"}

    filepath: text("File", "The preset", subtype="FILE_PATH", options={"SKIP_SAVE"})

    def execute(self, context: Context) -> Answer:
        with _settings_as_operator(context):
            execute: Any = bpy.ops.script.execute_preset  # its stub returns None
            return execute(filepath=self.filepath, menu_idname="VIEW3D_PT_fairing_presets")


class OBJECT_OT_fairing_preset_add(AddPresetBase, bpy.types.Operator):
    """Save the settings of the panel under a name, or remove a name"""

    bl_idname = "object.fairing_preset_add"
    bl_label = "Add Fairing Preset"
    preset_menu = "VIEW3D_PT_fairing_presets"
    preset_subdir = PRESET_FOLDER
    preset_defines = ["op = bpy.context.active_operator"]
    preset_values = [f"op.{name}" for name in NAMES if name not in NOT_KEPT]

    def execute(self, context: Context) -> Answer:
        with _settings_as_operator(context):
            return cast(Any, super()).execute(context)


def register() -> None:
    bpy.utils.register_preset_path(_FOLDER)


def unregister() -> None:
    bpy.utils.unregister_preset_path(_FOLDER)
