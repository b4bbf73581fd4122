# SPDX-License-Identifier: GPL-3.0-or-later
"""Names that scripts and keymaps still use, for one version."""

import bpy

from ..blender import registration
from .fair import FairSurface


class OBJECT_OT_fair_surface(FairSurface, bpy.types.Operator):
    """The old name of Fair Surface, which goes with the next version: use object.fairing_surface"""

    bl_idname = "object.fair_surface"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}


register, unregister = registration(OBJECT_OT_fair_surface)
