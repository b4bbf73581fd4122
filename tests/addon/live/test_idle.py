# SPDX-License-Identifier: GPL-3.0-or-later
"""While no one uses the add-on it does next to nothing."""

from types import SimpleNamespace

import bpy
import numpy as np
from fake_layout import draw
from live_scenes import follow, live, pull
from scenes import CUBE, activate, add, fair, weights

from addon import events
from addon.mesh import groups, mesh_changes
from addon.ui import main


def test_no_operator_is_called_in_a_handler(source, monkeypatch):
    source.vertex_groups.new(name="Theirs").add([0, 1, 2], 0.5, "REPLACE")
    source.vertex_groups["Theirs"].add([1], 0.25, "REPLACE")
    target = fair(levels=2)
    target.vertex_groups.new(name="Mine").add([0, 9], 0.125, "REPLACE")
    expected = weights(target, "Theirs")

    def refuse(*_):
        raise AssertionError("an operator in a handler")

    monkeypatch.setattr(groups, "_convert", refuse)
    activate(target)
    live(target)
    target.discrete_fairing_live.levels = 1
    target.update_tag()
    follow()
    pull(source)
    assert not target.discrete_fairing_live.status.count("unexpected")
    assert len(target.data.polygons) == 6 * 4
    shown = weights(target, "Theirs")
    assert np.array_equal(shown[:8], expected[:8], equal_nan=True) and np.nanmax(shown) == 0.5
    assert target.vertex_groups["Mine"].weight(0) == 0.125


def test_panels_measure_a_mesh_once_for_each_change(monkeypatch):
    """A window draws panels all the time; large meshes wait for a pause."""
    timers, drawn = SimpleNamespace(is_registered=lambda _: bool(waiting)), []
    waiting = []
    timers.register = lambda timer, **_: waiting.append(timer)
    window = SimpleNamespace(background=False, timers=timers)
    for module in (mesh_changes, events):
        monkeypatch.setattr(module, "bpy", SimpleNamespace(app=window, data=bpy.data))
    read = main.read_mesh
    monkeypatch.setattr(main, "read_mesh", lambda mesh: drawn.append(mesh) or read(mesh))
    settings = bpy.context.scene.discrete_fairing
    settings.interpolation, settings.tolerance = "APPROXIMATE", 0.25

    def said():
        return [line for line in draw(main.VIEW3D_PT_fairing) if str(line).startswith("= ")]

    source = add("Box", *CUBE)
    follow()
    assert said() == said() == ["= 0.5 m"] and len(drawn) == 1
    source.scale = (2.0, 2.0, 2.0)
    assert said() == said() == ["= 1 m"] and len(drawn) == 2
    source.data.vertices[0].co.x -= 6.0
    source.data.update()
    follow()
    assert said() == said() != ["= 1 m"] and len(drawn) == 3
    monkeypatch.setattr(mesh_changes, "MEASURED_WHILE_DRAWING", 3)
    source.data.vertices[0].co.x += 6.0
    source.data.update()
    follow()
    assert said() == said() == [] and len(drawn) == 3, "not while it is drawn"
    waiting.pop()()
    assert not waiting and said() == ["= 1 m"] and len(drawn) == 4
