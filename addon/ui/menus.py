# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's own menus, which its search (F3) uses to find operators."""

from typing import Any

import bpy

from ..blender import Context
from ..choices import EDGE_BOUNDARIES
from ..inspection.settings import MODES
from ..purposes import PURPOSES, TRADES
from . import pictures


class VIEW3D_MT_fairing_for(bpy.types.Menu):
    bl_label = "Fair for"

    def draw(self, _context: Context) -> None:
        layout: Any = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        for purpose, label, *_ in PURPOSES:
            button = layout.operator(
                "object.fairing_for",
                text=f"{label}: {TRADES[purpose]}",
                icon_value=pictures.icon(purpose),
            )
            button.purpose = purpose


class VIEW3D_MT_fairing(bpy.types.Menu):
    bl_label = "Fairing"

    def draw(self, _context: Context) -> None:
        layout: Any = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator("object.fairing_surface", icon="SURFACE_DATA")
        layout.menu(VIEW3D_MT_fairing_for.__name__)
        layout.operator("object.fairing_in_place", icon="MOD_SMOOTH")
        layout.operator("object.fairing_clean")
        layout.operator("object.fairing_fit")
        layout.operator("object.fairing_fill")
        layout.operator("object.fairing_curves", text="Fair Surface from Curves (Loft, Network)")
        layout.operator("object.fairing_flat_faces")
        layout.operator("object.fairing_match_border")
        layout.operator("object.fairing_recompute", icon="FILE_REFRESH")
        layout.operator("object.fairing_recompute_stale")
        layout.operator("object.fairing_live")
        layout.operator("object.fairing_show_source")
        layout.operator("object.fairing_show_patches")
        layout.operator("export_scene.fairing_step", text="Export STEP for CAD")
        layout.separator()
        layout.operator("object.fairing_check")
        layout.operator("object.fairing_joints")
        layout.operator("object.fairing_select_faults")
        layout.separator()
        layout.operator("object.fairing_refresh")
        for mode, label, *_ in MODES:
            button: Any = layout.operator("object.fairing_inspect", text=f"Inspect: {label}")
            button.mode = mode
        layout.operator("object.fairing_strain")
        layout.operator("object.fairing_select_strained")
        layout.operator("object.fairing_crease_knuckle")
        layout.operator("object.fairing_ease")
        layout.operator("object.fairing_ease_selected")
        layout.operator("object.fairing_strain_table")
        layout.separator()
        layout.operator("object.fairing_close")
        layout.operator("object.fairing_section_curves")
        layout.operator("object.fairing_hydrostatics")
        layout.operator("object.fairing_hydrostatics_table")


class VIEW3D_MT_fairing_boundary(bpy.types.Menu):
    bl_label = "Fairing Boundary"

    def draw(self, _context: Context) -> None:
        layout: Any = self.layout
        for key, name, *_ in EDGE_BOUNDARIES:
            layout.operator("object.fairing_boundary", text=name).boundary = key
        layout.separator()
        for key, name, *_, number in EDGE_BOUNDARIES:
            if number:
                button = layout.operator("object.fairing_select_boundary", text=f"Select {name}")
                button.boundary = key


class VIEW3D_MT_fairing_normals(bpy.types.Menu):
    bl_label = "Fairing Normals"

    def draw(self, _context: Context) -> None:
        layout: Any = self.layout
        layout.operator("object.fairing_fix_normal", text="Fix as in the Mesh")
        layout.operator("object.fairing_free_normal")


def _draw_one(menu: Any, _context: Context) -> None:
    menu.layout.separator()
    menu.layout.operator_context = "INVOKE_DEFAULT"
    menu.layout.operator("object.fairing_surface", icon="SURFACE_DATA")
    menu.layout.menu(VIEW3D_MT_fairing_for.__name__)


def _draw_all(menu: Any, context: Context) -> None:
    _draw_one(menu, context)
    menu.layout.menu(VIEW3D_MT_fairing.__name__)


def _draw_faces(menu: Any, _context: Context) -> None:
    """In Edit Mode: for selected faces."""
    menu.layout.separator()
    menu.layout.operator_context = "INVOKE_DEFAULT"
    button = menu.layout.operator(
        "object.fairing_surface", text="Fair Selected Faces", icon="SURFACE_DATA"
    )
    button.use_selection = True
    menu.layout.operator("object.fairing_in_place", icon="MOD_SMOOTH")
    menu.layout.operator("object.fairing_fill")
    menu.layout.operator("object.fairing_flat_faces")


def _draw_edges(menu: Any, _context: Context) -> None:
    menu.layout.separator()
    menu.layout.operator("object.fairing_fill")
    menu.layout.menu(VIEW3D_MT_fairing_boundary.__name__)


def _draw_vertices(menu: Any, _context: Context) -> None:
    menu.layout.separator()
    menu.layout.menu(VIEW3D_MT_fairing_normals.__name__)
    menu.layout.operator_context = "INVOKE_DEFAULT"
    menu.layout.operator("object.fairing_select_strained")
    menu.layout.operator("object.fairing_ease_selected")


def _draw_export(menu: Any, _context: Context) -> None:
    menu.layout.operator("export_scene.fairing_step", text="Fair Surface (.step)")
    menu.layout.operator("export_scene.fairing_lines", text="Lines Plan of a Hull (.dxf)")


def _draw_import(menu: Any, _context: Context) -> None:
    menu.layout.operator("import_mesh.fairing_offsets", text="Offsets of a Hull (.csv)")


def _draw_add(menu: Any, _context: Context) -> None:
    menu.layout.separator()
    menu.layout.operator_context = "INVOKE_DEFAULT"
    menu.layout.operator("object.fairing_curves", icon="SURFACE_DATA")


_ENTRIES = {
    "VIEW3D_MT_mesh_add": _draw_add,
    "VIEW3D_MT_object": _draw_all,
    "VIEW3D_MT_object_context_menu": _draw_one,
    "VIEW3D_MT_edit_mesh": _draw_all,
    "VIEW3D_MT_edit_mesh_context_menu": _draw_faces,
    "VIEW3D_MT_edit_mesh_edges": _draw_edges,
    "VIEW3D_MT_edit_mesh_vertices": _draw_vertices,
    "VIEW3D_MT_edit_mesh_faces": _draw_faces,
    "TOPBAR_MT_file_export": _draw_export,
    "TOPBAR_MT_file_import": _draw_import,
}


def register() -> None:
    for name, draw in _ENTRIES.items():
        getattr(bpy.types, name).append(draw)


def unregister() -> None:
    for name, draw in _ENTRIES.items():
        getattr(bpy.types, name).remove(draw)
