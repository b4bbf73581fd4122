# SPDX-License-Identifier: GPL-3.0-or-later
"""Helpers for tests of Live. Nothing redraws here: `follow` lets Blender see changes."""

from time import monotonic, sleep

import bpy
import numpy as np
from scenes import CUBE, activate, add, fair, positions

from addon.live import handlers, registry

PATIENCE = 60.0  # seconds


def follow():
    """Blender's update of its dependency graph, which calls the handlers."""
    bpy.context.view_layer.update()


def surface_of(source):
    return next(o for o in bpy.data.objects if o.discrete_fairing.source == source)


def live(active):
    """Switches Live on for `active`, a source or a surface, and returns the surface."""
    activate(active)
    assert bpy.ops.object.fairing_live() == {"FINISHED"}
    follow()
    return active if active.discrete_fairing.source else surface_of(active)


def session(target):
    """The session that keeps `target` live, or None."""
    return registry.session_of(target)


def move(source, index=0, by=0.5):
    source.data.vertices[index].co.z += by
    source.data.update()


def pull(source, index=0, by=0.5):
    """Moves a vertex, and lets Blender see it."""
    move(source, index, by)
    follow()


def through(target, source):
    """Whether a surface passes its control vertices, to the bit."""
    count = len(source.data.vertices)
    return np.array_equal(positions(target.data)[:count], positions(source.data))


def whole(target):
    """Plays the timer until the full level is there."""
    tick_until(lambda: not session(target).is_waiting)


def tick_until(done):
    """Plays the timer that a window would have."""
    end = monotonic() + PATIENCE
    while not done():
        assert monotonic() < end
        handlers.on_timer()
        sleep(0.005)


def box(levels=2, live_levels=1):
    source = add("Box", *CUBE)
    target = fair(levels=levels)
    target.discrete_fairing_live.levels = live_levels
    live(target)
    return source, target
