# SPDX-License-Identifier: GPL-3.0-or-later
"""The ends and interruptions of Live: undo, files, deleting, rendering, disabling."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from fake_layout import draw
from live_scenes import box, live, move, pull, session, through, tick_until
from scenes import CUBE, activate, add, fair, positions, recompute, reopen

import addon
from addon.live import handlers, live_solver, registry, restored, switch
from addon.surfaces.freshness import UNFINISHED, why_stale
from addon.ui import main


def registered():
    """All handlers of the add-on, by Blender's lists."""
    return {
        name: [f for f in getattr(bpy.app.handlers, name) if f.__module__ == "addon.events"]
        for name in handlers.HANDLERS
    }


def box_that_undo_switches():
    """A source hidden under its surface, and Live switched on with a click."""
    bpy.context.preferences.edit.use_global_undo = True
    add("Box", *CUBE)
    target = fair(levels=2)
    target.discrete_fairing_live.levels = 1
    bpy.ops.ed.undo_push(message="made")
    live(target)
    bpy.ops.ed.undo_push(message="live")
    return box_as_it_is()


def box_as_it_is():
    """The box after undo, which makes all objects anew."""
    source, target = bpy.data.objects["Box"], bpy.data.objects["Box Fair"]
    return source, target, (source.hide_get(), source.display_type, len(target.data.polygons))


def test_undo_takes_live_along():
    source, target, on = box_that_undo_switches()
    assert on == (False, "WIRE", 6 * 4)
    bpy.ops.ed.undo()
    source, target, off = box_as_it_is()
    assert off == (True, "TEXTURED", 6 * 4**2) and not target.discrete_fairing_live.on
    handlers.on_timer()
    assert box_as_it_is()[2] == off and registry.sessions() == []
    bpy.ops.ed.redo()
    assert restored.resume() is None
    source, target, again = box_as_it_is()
    assert again == on and target.discrete_fairing_live.on
    pull(source)
    assert through(target, source)
    target.discrete_fairing_live.on = False
    assert box_as_it_is()[2] == (False, "TEXTURED", 6 * 4**2)


def test_undo_wakes_no_copy_and_no_surface_of_another_file(tmp_path):
    source, target, _ = box_that_undo_switches()
    copy = target.copy()
    copy.data = target.data.copy()
    bpy.context.collection.objects.link(copy)
    for sessions in (1, 0):
        bpy.ops.ed.undo_push(message="copied or opened")
        bpy.ops.ed.undo_push(message="more")
        bpy.ops.ed.undo()
        restored.resume()
        assert len(registry.sessions()) == sessions
        reopen(tmp_path)


def test_another_file_ends_it(tmp_path):
    box()
    assert registry.sessions()
    reopen(tmp_path)
    assert registry.sessions() == []
    target = bpy.data.objects["Box Fair"]
    assert not target.discrete_fairing_live.on and target.discrete_fairing_live.levels == 1
    pull(bpy.data.objects["Box"])
    assert bpy.ops.object.fairing_live() == {"FINISHED"}


@pytest.mark.parametrize("which, reason", [("source", "source"), ("target", "surface")])
@pytest.mark.parametrize(
    "way", [lambda gone: bpy.data.objects.remove(gone), lambda _: bpy.ops.object.delete()]
)
def test_deleted(which, reason, way):
    source, target = box()
    identity = session(target).key
    gone = source if which == "source" else target
    activate(gone)
    way(gone)
    handlers.on_timer()
    assert registry.sessions() == []
    assert reason in registry._endings[identity].lower()
    if which == "source":
        assert "source was deleted" in target.discrete_fairing_live.status


def test_disabling_leaves_nothing():
    source, target = box()
    everything = registered()
    assert {len(found) for found in everything.values()} == {1}
    try:
        before = positions(target.data)
        addon.unregister()
        assert not any(registered().values()) and registry.sessions() == []
        assert not bpy.app.timers.is_registered(handlers.on_timer)
        pull(source)
        assert np.array_equal(positions(target.data), before)
    finally:
        addon.register()
    assert [len(found) for found in registered().values()] == [1] * len(everything)
    assert not target.discrete_fairing_live.on


def test_an_unexpected_error_ends_it_and_is_told(monkeypatch):
    source, target = box()

    def fail(*_):
        raise ZeroDivisionError

    monkeypatch.setattr(live_solver, "read_mesh", fail)
    move(source)
    with pytest.raises(ZeroDivisionError):
        handlers.guarded(
            session(target), lambda it: it.follow(bpy.context.evaluated_depsgraph_get())
        )
    assert registry.sessions() == [] and "ZeroDivisionError" in target.discrete_fairing_live.status


def test_linked_surfaces_are_refused(tmp_path):
    add("Box", *CUBE)
    fair(levels=1)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "library.blend"))
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.objects = ["Box Fair"]
    target = wanted.objects[0]
    bpy.context.collection.objects.link(target)
    activate(target)
    assert not bpy.ops.object.fairing_live.poll()
    target.discrete_fairing_live.on = True
    assert not target.discrete_fairing_live.on and "linked" in switch.why_not(target)


def test_undo_of_a_later_step_says_that_the_surface_is_not_whole(no_pause):
    """Live writes its last full level after the step of the click, so the next step's undo takes it back."""
    source, target, _ = box_that_undo_switches()
    session(target).ending = True  # what the click does where there is a window
    registry.note(target, False)
    bpy.ops.ed.undo_push(message="off")
    tick_until(lambda: session(target) is None)
    assert len(target.data.polygons) == 6 * 4**2 and why_stale(target) == ""
    add("Other", *CUBE)
    bpy.ops.ed.undo_push(message="other")
    bpy.ops.ed.undo()
    source, target, now = box_as_it_is()
    assert now[2] == 6 * 4 and why_stale(target) == UNFINISHED
    assert badges(target) == ["Out of date: shown with fewer levels"]
    recompute()
    assert len(target.data.polygons) == 6 * 4**2 and why_stale(target) == "" and not badges(target)


def badges(target):
    activate(target)
    return [line for line in draw(main.VIEW3D_PT_fairing) if "out of date" in line.lower()]


@pytest.mark.parametrize("locked", [True, False])
def test_renders_write_only_while_no_window_draws(monkeypatch, locked):
    source, target = box()
    scene = bpy.context.scene
    assert not scene.render.use_lock_interface
    target.discrete_fairing_live.in_renders = True
    assert scene.render.use_lock_interface, "switched on with it"
    scene.render.use_lock_interface = locked
    shown = draw(main.VIEW3D_PT_fairing)
    assert ("use_lock_interface" in shown) != locked
    window = SimpleNamespace(app=SimpleNamespace(background=False), data=bpy.data)
    monkeypatch.setattr(handlers, "bpy", window)
    before = positions(target.data)
    handlers._render_begins(scene)
    pull(source)
    assert np.array_equal(positions(target.data), before) != locked
    handlers._render_ends()
