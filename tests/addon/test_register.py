# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

import addon
from addon import core


def registered():
    kinds = ("OBJECT_OT_fairing", "VIEW3D_PT_fairing", "VIEW3D_MT_fairing")
    found = {kind: any(name.startswith(kind) for name in dir(bpy.types)) for kind in kinds}
    return [*found.values(), hasattr(bpy.types.Scene, "discrete_fairing")]


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
