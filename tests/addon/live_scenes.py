# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of Live share. Without a window nothing redraws: `follow` lets Blender see what has changed."""

import bpy
from scenes import activate

from addon.live import registry


def follow():
    """Blender's update of its dependency graph, which calls the handlers."""
    bpy.context.view_layer.update()


def surface_of(source):
    return next(o for o in bpy.data.objects if o.discrete_fairing.source == source)


def live(active):
    """Switches Live on for `active`, a source or a surface, and returns the surface."""
    activate(active)
    assert bpy.ops.object.fair_live(state="ON") == {"FINISHED"}
    follow()
    return active if active.discrete_fairing.source else surface_of(active)


def session(target):
    """What keeps `target` live, or None."""
    return registry.session_of(target)
