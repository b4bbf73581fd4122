# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Hull": tools of a boat yard for a half hull and its surface."""

from typing import Any

import bpy

from ..blender import Context
from .layout import Folded


class VIEW3D_PT_fairing_hull(Folded, bpy.types.Panel):
    bl_label = "Hull"

    def draw(self, _context: Context) -> None:
        layout: Any = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator("import_mesh.fairing_offsets", icon="IMPORT")
        layout.operator("object.fairing_section_curves")
        layout.operator("export_scene.fairing_lines", icon="EXPORT")
        layout.operator("object.fairing_close")
        layout.operator("object.fairing_hydrostatics")
        layout.operator("object.fairing_hydrostatics_table", icon="FILE_TEXT")
