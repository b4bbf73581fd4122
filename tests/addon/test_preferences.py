# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user prefers reaches scenes and the core."""

from types import SimpleNamespace

import bpy
from scenes import CUBE, add

from addon import preferences
from addon.core import fair_arguments
from addon.mesh.read import read_mesh
from addon.settings import snapshot


def prefer(monkeypatch, **values):
    chosen = SimpleNamespace(**{"levels": 3, "memory_limit": 0, "threads": 0, **values})
    monkeypatch.setattr(preferences, "preferences", lambda: chosen)
    return chosen


def test_new_files_begin_with_the_default_levels(monkeypatch):
    prefer(monkeypatch, levels=5)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert bpy.context.scene.discrete_fairing.levels == 5


def test_new_scenes_too(monkeypatch):
    prefer(monkeypatch, levels=5)
    bpy.ops.scene.new(type="EMPTY")
    add("Box", *CUBE)
    bpy.context.view_layer.update()
    assert bpy.context.scene.discrete_fairing.levels == 5


def test_chosen_levels_are_left_alone(monkeypatch):
    prefer(monkeypatch, levels=5)
    bpy.context.scene.discrete_fairing.levels = 3
    preferences.give_scenes_default_levels()
    assert bpy.context.scene.discrete_fairing.levels == 3


def test_memory_and_threads_reach_the_core(monkeypatch):
    chosen = prefer(monkeypatch, memory_limit=7, threads=1)
    arrays, settings = (
        read_mesh(add("Box", *CUBE).data),
        snapshot(bpy.context.scene.discrete_fairing),
    )
    given = fair_arguments(arrays, settings, chosen)
    assert given["memory_limit"] == 7 * 2**20 and given["threads"] == 1
    settings.memory_limit = 9
    assert fair_arguments(arrays, settings, chosen)["memory_limit"] == 9 * 2**20


def test_not_installed_means_defaults():
    assert preferences.preferences() is preferences.Defaults
