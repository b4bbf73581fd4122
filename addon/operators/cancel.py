# SPDX-License-Identifier: GPL-3.0-or-later
"""A button that cancels the present run."""

import bpy

from ..blender import Answer, Context
from ..poll import ExplainedPoll, needs
from ..queue import running


class OBJECT_OT_fairing_cancel(ExplainedPoll, bpy.types.Operator):
    """End the present run, as ESC does, and change nothing"""

    bl_idname = "object.fairing_cancel"
    bl_label = "Cancel"
    bl_options = {"INTERNAL"}

    reasons = (needs(lambda _: running(), "Nothing to cancel: no surface is being faired"),)

    def execute(self, _context: Context) -> Answer:
        if (queue := running()) is not None:
            queue.cancel()
        return {"FINISHED"}
