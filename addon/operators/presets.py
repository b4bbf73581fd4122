# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets by Blender's own machinery: shipped ones are in addon/presets, the user's in their own
folder.

A preset is a script that sets the active operator's properties, like those of Blender's redo panel. The
panel runs and saves the same scripts with its settings in place of the operator.
"""

from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import Any, cast

import bpy
import numpy as np
from bl_operators.presets import AddPresetBase
from bpy.props import EnumProperty

from ..blender import Answer, Context, Object
from ..check.turns import SHARP, has_flat_ends, why_bending
from ..control_arrays import ControlArrays
from ..fields import text
from ..memory import source_of
from ..mesh.read import control_mesh, control_meshes, read_mesh, source_objects
from ..mesh.world_shape import world_shape
from ..poll import ExplainedPoll, needs
from ..purposes import (
    EASED_FIRST,
    FOLDER,
    OPERATORS,
    OWN_VERTICES,
    PRESET_FOLDER,
    PURPOSES,
    preset_file,
)
from ..settings import NAMES, Settings, are_mirrored, mirror_axis
from ..ui.active import active_settings, fairing_operator, remembered
from ..yard.halves import settings_of_whole, why_round
from .fair import can_fair

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


# an operator called by another one makes no undo step by itself; one called by a script makes none at
# all
_UNDO = True


def set_job(context: Context, purpose: str) -> None:
    """Gives the panel the settings of a job."""
    cast(Any, bpy.ops.object).fairing_preset_apply(filepath=str(preset_file(purpose)))


def suit_shapes(
    context: Context, purpose: str, sources: Sequence[Object], whole: dict[str, Any]
) -> str:
    """Changes the panel where the shapes of `sources` ask for it; sentences on that. `whole`: the settings of
    `whole_of`.
    """
    panel = active_settings(context)
    found = [source_of(source) or source for source in sources]
    said = []
    is_own = purpose in OWN_VERTICES and mirror_axis(found)
    if not (is_own or whole) and panel.symmetry_plane == "NONE" and are_mirrored(found):
        panel.mesh_source = "EVALUATED"
        said.append("The whole mesh is faired, with its Mirror modifier")
    if whole.get("symmetry_plane") == "NONE":
        said.append("Both halves keep the angle at which they meet")
    if purpose == "HULL":
        settings = replace(Settings.of(panel), **whole)
        for source in found:
            cage = _cage(context, source)
            if reason := why_bending(cage, settings) or why_round(cage, settings):
                panel.energy = "THIN_PLATE"
                said.append(f"Bending in place of Flow Lines for {source.name}: {reason}")
                if has_flat_ends(cage):
                    panel.use_crease_angle, panel.crease_angle = True, SHARP
                    said.append(f"Edges folded by {np.degrees(SHARP):.0f}° and more are sharp")
                break
    return ". ".join(said)


def whole_of(context: Context, purpose: str, sources: Sequence[Object]) -> dict[str, Any]:
    """Settings by which the next surface of halves under Mirror is the whole. They are not those of the panel, which
    the next mesh gets too.
    """
    axis, is_own = mirror_axis(sources), purpose in OWN_VERTICES
    is_set = remembered(context) is not None or active_settings(context).symmetry_plane != "NONE"
    if is_set or not axis or (are_mirrored(sources) and not is_own):
        return {}
    cages = [_cage(context, source) for source in sources]
    return settings_of_whole(cages, axis, Settings.of(active_settings(context)), is_own)


def _cage(context: Context, source: Object) -> ControlArrays:
    with control_mesh(context, source) as mesh:
        return world_shape(source).of_arrays(read_mesh(mesh))


class OBJECT_OT_fairing_for(ExplainedPoll, bpy.types.Operator):
    """Fair the selected meshes with the settings of a purpose; the panel then shows them"""

    bl_idname = "object.fairing_for"
    bl_label = "Fair for"
    bl_options = {"INTERNAL"}  # the operators that it runs make their own undo steps

    purpose: EnumProperty(name="Purpose", items=PURPOSES)

    @classmethod
    def description(cls, _context: Context, properties: Any) -> str:
        return next(text for key, _, text, _ in PURPOSES if key == properties.purpose)

    reasons = (can_fair, needs(source_objects, "Select a mesh object first"))

    def invoke(self, context: Context, _event: bpy.types.Event) -> Answer:
        return self._run_or_say(context, "INVOKE_DEFAULT")

    def execute(self, context: Context) -> Answer:
        return self._run_or_say(context, "EXEC_DEFAULT")

    def _run_or_say(self, context: Context, how: str) -> Answer:
        """Runs the operator; an error reported by it is an exception here, and is reported as a
        message.
        """
        try:
            return self._run(context, how)
        except RuntimeError as error:
            self.report({"ERROR"}, str(error).removeprefix("Error: ").strip())
            return {"CANCELLED"}

    def _run(self, context: Context, how: str) -> Answer:
        operators: Any = bpy.ops.object
        if self.purpose in OPERATORS:
            return getattr(operators, OPERATORS[self.purpose])(how, _UNDO)
        path = preset_file(self.purpose)
        if path is None:
            return operators.fairing_in_place(how, _UNDO, vertices="MEASURED")
        sources = control_meshes(context)
        set_job(context, self.purpose)
        whole = whole_of(context, self.purpose, sources)
        said = suit_shapes(context, self.purpose, sources, whole)
        if said:
            self.report({"INFO"}, said)
        if self.purpose in EASED_FIRST:
            if how == "INVOKE_DEFAULT":
                return operators.fairing_ease(how, _UNDO, fair_afterwards=True)
            operators.fairing_ease(how)
        if how == "INVOKE_DEFAULT" or remembered(context) is not None:
            return fairing_operator(context)(how, _UNDO, **whole)
        settings = asdict(Settings.of(active_settings(context)))
        return operators.fairing_surface(how, _UNDO, **(settings | whole))
