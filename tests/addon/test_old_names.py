# SPDX-License-Identifier: GPL-3.0-or-later
"""One prefix for all operators; the name from before does the same for a version."""

import bpy
import numpy as np
from scenes import CUBE, add, fair, positions

OLD = {"fair_surface"}


def test_all_operators_have_one_prefix():
    own = {name for name in dir(bpy.types) if name.startswith("OBJECT_OT_fair")}
    assert {name for name in own if not name.startswith("OBJECT_OT_fairing_")} == {
        f"OBJECT_OT_{name}" for name in OLD
    }


def test_the_old_name_makes_the_same_surface():
    add("Box", *CUBE)
    assert bpy.ops.object.fair_surface(levels=2, tension=0.5) == {"FINISHED"}
    old = positions(bpy.context.active_object.data)
    add("Box", *CUBE)
    assert np.array_equal(old, positions(fair(levels=2, tension=0.5).data))


def test_the_old_name_is_not_found_twice():
    """Neither by Blender's search, which leaves internal operators out, nor by its presets."""
    assert "INTERNAL" in bpy.types.OBJECT_OT_fair_surface.bl_options
    assert "PRESET" not in bpy.types.OBJECT_OT_fair_surface.bl_options
