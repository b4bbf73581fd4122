# SPDX-License-Identifier: GPL-3.0-or-later
"""Live and everything that ends, interrupts or follows it: the full level, undo, files, deleting, rendering, disabling."""

from time import monotonic, sleep

import bpy
import numpy as np
import pytest
from fake_layout import draw
from live_scenes import follow, live, session, surface_of
from scenes import CUBE, activate, add, fair, positions

import addon
from addon import native
from addon.interface import panel
from addon.live import full_level, registry, switch, watch
from addon.live import session as session_module

PATIENCE = 60.0  # seconds


def move(source, index=0, by=0.5):
    source.data.vertices[index].co.z += by
    source.data.update()


def tick_until(done):
    """Plays the timer that a window would have."""
    end = monotonic() + PATIENCE
    while not done():
        assert monotonic() < end
        watch.tick()
        sleep(0.005)


def handlers():
    """All of the add-on's own that Blender would call, by their lists."""
    return {
        name: [f for f in getattr(bpy.app.handlers, name) if f.__module__.startswith("addon.live")]
        for name in watch._HANDLERS
    }


@pytest.fixture
def no_pause(monkeypatch):
    monkeypatch.setattr(session_module, "PAUSE", 0.0)


def box(levels=2, live_levels=1):
    source = add("Box", *CUBE)
    target = fair(levels=levels)
    target.discrete_fairing_live.levels = live_levels
    live(target)
    return source, target


def test_the_full_level_comes_when_the_edit_pauses(no_pause):
    source, target = box()
    assert len(target.data.polygons) == 6 * 4
    move(source)
    follow()
    tick_until(lambda: not session(target).is_waiting)
    shown = positions(target.data)
    assert len(target.data.polygons) == 6 * 4**2 and target.discrete_fairing_live.on
    activate(target)
    bpy.ops.object.fair_recompute()
    assert np.array_equal(positions(target.data), shown), "the very surface of Recompute"


def test_the_next_edit_starts_from_the_shape_that_is_there(no_pause):
    """A fresh solver comes with the full level: charts of the new shape, and its surface to start from."""
    source, target = box()
    move(source)
    follow()
    before = session(target).solver
    tick_until(lambda: not session(target).is_waiting)
    fresh = session(target).solver
    assert fresh is not before and fresh.solve().report["warm"]
    move(source)
    follow()
    assert session(target).solver is fresh, "one for the whole edit"


def test_not_before_the_pause():
    _, target = box()
    watch.tick()
    assert session(target).is_waiting and not session(target).full_text


def test_not_while_the_mouse_drags(no_pause, monkeypatch):
    _, target = box()
    monkeypatch.setattr(session_module, "is_editing", lambda context: True)
    watch.tick()
    assert session(target).is_waiting and not session(target).full_text


@pytest.mark.parametrize(
    "name, edits", [("TRANSFORM_OT_translate", True), ("MESH_OT_bevel", True), ("WM_OT_watch", False)]
)
def test_which_modal_operators_are_edits(name, edits):
    class Manager:
        class window:
            class screen:
                is_animation_playing = False

            class operator:
                bl_idname = name

            modal_operators = (operator,)

        windows = (window,)

    class Context:
        window_manager = Manager

    assert full_level.is_editing(Context) == edits


def test_an_edit_cancels_the_full_level_and_it_comes_after_all(no_pause):
    source, target = box(levels=6)
    move(source)
    follow()
    watch.tick()
    assert session(target).full_text
    move(source)
    follow()
    assert not session(target).full_text and len(target.data.polygons) == 6 * 4
    tick_until(lambda: not session(target).is_waiting)
    assert len(target.data.polygons) == 6 * 4**6
    assert np.array_equal(positions(target.data)[:8], positions(source.data))
    move(source)
    follow()
    assert len(target.data.polygons) == 6 * 4, "back to the live level"


def test_the_full_level_in_edit_mode(no_pause):
    """With weights, which only an operator of Blender's writes."""
    source = add("Box", *CUBE)
    source.vertex_groups.new(name="Group").add([0, 1], 0.5, "REPLACE")
    target = fair(levels=2)
    live(target)
    activate(source)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.transform.translate(value=(0, 0, 1))
    follow()
    tick_until(lambda: not session(target).is_waiting)
    assert source.mode == "EDIT" and len(target.data.polygons) == 6 * 4**2
    assert not session(target).trouble and target.vertex_groups["Group"].weight(0) == 0.5


def test_the_same_level_only_moves_the_mesh_of_the_full_one(no_pause):
    source, target = box(levels=2, live_levels=2)
    tick_until(lambda: not session(target).is_waiting)
    target.data["mine"] = 1
    move(source)
    follow()
    assert target.data["mine"] == 1 and target.data.attributes and len(target.data.polygons) == 6 * 4**2
    assert np.array_equal(positions(target.data)[:8], positions(source.data))


def test_an_edit_of_the_surface_itself_waits(no_pause):
    source, target = box()
    activate(target)
    bpy.ops.object.mode_set(mode="EDIT")
    move(source)
    follow()
    watch.tick()
    assert "waits" in target.discrete_fairing_live.status and target.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    tick_until(lambda: not session(target).is_waiting)
    assert np.array_equal(positions(target.data)[:8], positions(source.data))


def test_switched_off_with_the_full_level():
    source, target = box()
    move(source)
    follow()
    target.discrete_fairing_live.on = False
    assert len(target.data.polygons) == 6 * 4**2 and registry.sessions() == []
    move(source)
    follow()
    assert positions(target.data)[0][2] != source.data.vertices[0].co.z


def test_switched_off_in_a_window(no_pause, monkeypatch):
    _, target = box()
    session(target).ending = True
    assert not target.discrete_fairing_live.on
    tick_until(lambda: not registry.sessions())
    assert len(target.data.polygons) == 6 * 4**2
    assert watch.tick() is None, "the timer ends"


def test_undo_and_redo():
    bpy.context.preferences.edit.use_global_undo = True
    source, target = box()
    bpy.ops.ed.undo_push(message="before")
    move(source)
    follow()
    bpy.ops.ed.undo_push(message="after")
    for step, height in ((bpy.ops.ed.undo, -1.0), (bpy.ops.ed.redo, -0.5)):
        step()
        watch.tick()
        source, target = bpy.data.objects["Box"], bpy.data.objects["Box Fair"]
        assert source.data.vertices[0].co.z == height
        assert target.discrete_fairing_live.on
        assert np.array_equal(positions(target.data)[:8], positions(source.data))


def test_undo_of_the_surface_itself():
    add("Box", *CUBE)
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.object.fair_live()
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert "Box Fair" not in bpy.data.objects
    watch.tick()
    assert registry.sessions() == []


def test_undo_while_the_full_level_is_computed(no_pause):
    source, target = box(levels=6)
    bpy.ops.ed.undo_push(message="before")
    move(source)
    follow()
    bpy.ops.ed.undo_push(message="after")
    watch.tick()
    assert session(target).full_text
    bpy.ops.ed.undo()
    source, target = bpy.data.objects["Box"], bpy.data.objects["Box Fair"]
    tick_until(lambda: not session(target).is_waiting)
    assert len(target.data.polygons) == 6 * 4**6
    assert np.array_equal(positions(target.data)[:8], positions(source.data))


def test_another_file_ends_it(tmp_path):
    box()
    path = str(tmp_path / "live.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    assert registry.sessions()
    bpy.ops.wm.open_mainfile(filepath=path)
    assert registry.sessions() == []
    target = bpy.data.objects["Box Fair"]
    assert not target.discrete_fairing_live.on and target.discrete_fairing_live.levels == 1
    move(bpy.data.objects["Box"])
    follow()
    assert bpy.ops.object.fair_live(state="ON") == {"FINISHED"}


@pytest.mark.parametrize("which, reason", [("source", "source"), ("target", "surface")])
@pytest.mark.parametrize("way", ["remove", "operator"])
def test_deleted(which, reason, way):
    source, target = box()
    identity = session(target).key
    gone = source if which == "source" else target
    if way == "remove":
        bpy.data.objects.remove(gone)
    else:
        activate(gone)
        bpy.ops.object.delete()
    watch.tick()
    assert registry.sessions() == []
    assert reason in registry._endings[identity].lower()
    if which == "source":
        assert "source was deleted" in target.discrete_fairing_live.status


def test_deleted_while_the_full_level_is_computed(no_pause):
    _, target = box(levels=6)
    watch.tick()
    assert session(target).full_text
    bpy.data.objects.remove(target)
    watch.tick()
    assert registry.sessions() == []


def test_renamed():
    source, target = box()
    target.name, source.name = "Skin", "Cage"
    other = add("Box Fair", *CUBE)
    move(source)
    follow()
    assert (
        np.array_equal(positions(target.data)[:8], positions(source.data)) and len(other.data.vertices) == 8
    )


def test_nothing_is_written_while_rendering(no_pause):
    source, target = box()
    before = positions(target.data)
    handlers()["render_init"][0](None)
    move(source)
    follow()
    watch.tick()
    assert np.array_equal(positions(target.data), before)
    handlers()["render_complete"][0](None)
    tick_until(lambda: not session(target).is_waiting)
    assert np.array_equal(positions(target.data)[:8], positions(source.data))


def test_disabling_leaves_nothing():
    source, target = box()
    assert all(len(found) == 1 for found in handlers().values())
    try:
        before = positions(target.data)
        addon.unregister()
        assert not any(handlers().values()) and registry.sessions() == []
        assert not bpy.app.timers.is_registered(watch.tick)
        move(source)
        follow()
        assert np.array_equal(positions(target.data), before)
    finally:
        addon.register()
    assert all(len(found) == 1 for found in handlers().values())
    assert not target.discrete_fairing_live.on


def test_an_unexpected_error_ends_it_and_is_told(monkeypatch):
    source, target = box()

    def fail(*_):
        raise ZeroDivisionError

    monkeypatch.setattr(session_module, "read_arrays", fail)
    move(source)
    with pytest.raises(ZeroDivisionError):
        watch._attempt(session(target), lambda it: it.follow(bpy.context.evaluated_depsgraph_get()))
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
    assert not bpy.ops.object.fair_live.poll()
    target.discrete_fairing_live.on = True
    assert not target.discrete_fairing_live.on and "linked" in switch.why_not(target)


def test_grey_without_a_mesh_and_without_the_core(monkeypatch):
    assert not bpy.ops.object.fair_live.poll()
    add("Box", *CUBE)
    assert bpy.ops.object.fair_live.poll()
    monkeypatch.setattr(native, "_load", lambda: (None, native.MISSING))
    assert not bpy.ops.object.fair_live.poll()


def test_the_panel_says_how_it_goes():
    source = add("Box", *CUBE)
    assert "object.fair_live" in draw(panel.VIEW3D_PT_fairing)
    target = live(source)
    for active in (source, target):
        activate(active)
        log = draw(panel.VIEW3D_PT_fairing)
        assert "levels" in log and "Level 3: 768 triangles" in log
        assert any(line.startswith("Last update: ") for line in log)
    assert target.discrete_fairing_live.milliseconds > 0.0
    assert surface_of(source) == target
    bpy.data.objects.remove(source)
    watch.tick()
    activate(target)
    assert "The source was deleted" in " ".join(draw(panel.VIEW3D_PT_fairing))
