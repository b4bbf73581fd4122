# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

import addon
from addon import core

CLASSES = (
    "OBJECT_OT_fairing_surface",
    "OBJECT_OT_fairing_recompute",
    "OBJECT_OT_fairing_preset_add",
    "VIEW3D_PT_fairing",
    "OBJECT_OT_fairing_show_source",
    "VIEW3D_PT_fairing_inspect",
    "VIEW3D_PT_fairing_check",
    "VIEW3D_MT_fairing_for",
)


def registered():
    return [hasattr(bpy.types, name) for name in CLASSES] + [
        hasattr(bpy.types.Scene, "discrete_fairing")
    ]


def test_register_and_unregister_twice():
    assert all(registered())
    for _ in range(2):
        addon.unregister()
        assert not any(registered())
        addon.register()
        assert all(registered())


def test_without_the_native_module_the_button_is_grey_and_nothing_breaks(monkeypatch):
    monkeypatch.setattr(core, "_load", lambda: (None, core.MISSING))
    bpy.ops.mesh.primitive_cube_add()
    assert not bpy.ops.object.fairing_surface.poll()
    addon.unregister()
    addon.register()
