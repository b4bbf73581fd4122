# SPDX-License-Identifier: GPL-3.0-or-later
"""The full level of a live surface: when it comes, how it ends, and where the next edit begins."""

import bpy
import numpy as np
from live_scenes import box, follow, live, pull, session, through, tick_until, whole
from scenes import activate, fair, positions, recompute, to_object_mode

from addon.live import full_level, handlers, registry


def test_the_full_level_comes_when_the_edit_pauses(no_pause):
    source, target = box()
    assert len(target.data.polygons) == 6 * 4
    pull(source)
    whole(target)
    shown = positions(target.data)
    assert len(target.data.polygons) == 6 * 4**2 and target.discrete_fairing_live.on
    recompute(target)
    assert np.array_equal(positions(target.data), shown), "the very surface of Recompute"


def test_the_next_edit_starts_from_the_shape_that_is_there(no_pause):
    """A fresh solver comes with the full level, with charts of the new shape and its surface as the start."""
    source, target = box()
    pull(source)
    before = session(target).made.solver
    whole(target)
    fresh = session(target).made.solver
    assert fresh is not before and fresh.solve().report["warm"]
    pull(source)
    assert session(target).made.solver is fresh, "one for the whole edit"


def test_not_before_the_pause_and_not_while_the_mouse_drags(monkeypatch):
    _, target = box()
    handlers.on_timer()
    assert session(target).is_waiting and not session(target).full_text
    monkeypatch.setattr(full_level, "PAUSE", 0.0)
    monkeypatch.setattr(full_level, "is_editing", lambda context: True)
    handlers.on_timer()
    assert session(target).is_waiting and not session(target).full_text


def test_an_edit_cancels_the_full_level_and_it_comes_after_all(no_pause):
    source, target = box(levels=6)
    pull(source)
    handlers.on_timer()
    assert session(target).full_text
    pull(source)
    assert not session(target).full_text and len(target.data.polygons) == 6 * 4
    whole(target)
    assert len(target.data.polygons) == 6 * 4**6
    assert through(target, source)
    pull(source)
    assert len(target.data.polygons) == 6 * 4, "back to the live level"


def test_the_full_level_in_edit_mode(source, no_pause):
    """Also with weights, which only an operator of Blender writes."""
    source.vertex_groups.new(name="Group").add([0, 1], 0.5, "REPLACE")
    target = fair(levels=2)
    live(target)
    activate(source)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.transform.translate(value=(0, 0, 1))
    follow()
    whole(target)
    assert source.mode == "EDIT" and len(target.data.polygons) == 6 * 4**2
    assert not session(target).trouble and target.vertex_groups["Group"].weight(0) == 0.5


def test_an_edit_of_the_surface_itself_waits(no_pause):
    source, target = box()
    activate(target)
    bpy.ops.object.mode_set(mode="EDIT")
    pull(source)
    handlers.on_timer()
    assert "waits" in target.discrete_fairing_live.status and target.mode == "EDIT"
    to_object_mode()
    whole(target)
    assert through(target, source)


def test_switched_off_in_a_window(no_pause, monkeypatch):
    _, target = box()
    session(target).ending = True
    assert not target.discrete_fairing_live.on
    tick_until(lambda: not registry.sessions())
    assert len(target.data.polygons) == 6 * 4**2
    assert handlers.on_timer() is None, "the timer ends"
