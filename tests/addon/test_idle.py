# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on does while nothing is asked of it: next to nothing."""

import bpy
import numpy as np
import pytest
from fake_layout import draw
from live_scenes import follow, live, move
from scenes import CUBE, activate, add, fair

from addon import size
from addon.mesh import groups, mesh_changes
from addon.ui import main


@pytest.fixture
def counted(monkeypatch):
    """How often faces are counted."""
    calls, count = [], size.face_sizes
    monkeypatch.setattr(size, "face_sizes", lambda mesh: calls.append(mesh) or count(mesh))
    return calls


def test_faces_are_counted_once(counted):
    source = add("Box", *CUBE)
    for _ in range(3):
        assert "768 triangles" in draw(main.VIEW3D_PT_fairing)
    assert len(counted) == 1
    source.data.clear_geometry()
    source.data.from_pydata(CUBE[0], [], CUBE[1][:5])
    assert "640 triangles" in draw(main.VIEW3D_PT_fairing) and len(counted) == 2


class Update:
    """A depsgraph in which nobody may look."""

    @property
    def updates(self):
        raise AssertionError("looked at while nothing is watched")


def test_nothing_is_walked_while_nothing_is_watched():
    mesh_changes._note_changes(bpy.context.scene, Update())
    source = add("Box", *CUBE)
    mesh_changes.watch(bpy.context, source.data)
    with pytest.raises(AssertionError, match="looked at"):
        mesh_changes._note_changes(bpy.context.scene, Update())


def test_no_operator_is_called_in_a_handler(monkeypatch):
    source = add("Box", *CUBE)
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
    move(source)
    follow()
    assert not target.discrete_fairing_live.status.count("unexpected")
    assert len(target.data.polygons) == 6 * 4
    shown = weights(target, "Theirs")
    assert np.array_equal(shown[:8], expected[:8]) and shown.max() == 0.5
    assert target.vertex_groups["Mine"].weight(0) == 0.125


def weights(target, name):
    group = target.vertex_groups[name].index
    found = np.zeros(len(target.data.vertices))
    for vertex in target.data.vertices:
        for element in vertex.groups:
            if element.group == group:
                found[vertex.index] = element.weight
    return found
