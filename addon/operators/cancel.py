# SPDX-License-Identifier: GPL-3.0-or-later
"""A button that cancels the present run."""

import bpy

from ..blender import Context
from ..poll import needs
from ..queue import running
from .refusing import Action


class OBJECT_OT_fairing_cancel(Action, bpy.types.Operator):
    """End the present run, as ESC does, and change nothing"""

    bl_idname = "object.fairing_cancel"
    bl_label = "Cancel"
    bl_options = {"INTERNAL"}

    reasons = (needs(lambda _: running(), "Nothing to cancel: no surface is being faired"),)

    def act(self, _context: Context) -> None:
        if (queue := running()) is not None:
            queue.cancel()
