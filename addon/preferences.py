# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences, which apply to all files of a user."""

from dataclasses import dataclass
from typing import Any, TypeAlias

import bpy
from bpy.props import IntProperty, StringProperty

from . import events
from .blender import Context, Scene, all_scenes, current_context


class Defaults:
    """The values if the add-on is imported without being installed, as in tests."""

    levels = 3
    memory_limit = 0
    threads = 0
    speeds = "{}"


class DiscreteFairingPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    levels: IntProperty(
        name="Default Levels",
        description="How often faces are split in files where it has not been chosen yet",
        default=Defaults.levels,
        min=1,
        max=10,
        soft_max=5,
    )
    memory_limit: IntProperty(
        name="Memory Limit (MB)",
        description="Refuses runs that need more megabytes than this; 0: three quarters of the memory",
        default=Defaults.memory_limit,
        min=0,
        soft_max=65536,
    )
    threads: IntProperty(
        name="Threads",
        description="How many processor cores a run may use, or 0 for all; the surface is the same for any number",
        default=Defaults.threads,
        min=0,
        max=1024,
    )

    speeds: StringProperty(
        name="Speeds",
        description="Seconds a triangle of this machine's last runs, by fairness, as JSON",
        default=Defaults.speeds,
        options={"HIDDEN"},
    )

    def draw(self, _context: Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("levels", "memory_limit", "threads"):
            layout.prop(self, name)


Preferences: TypeAlias = DiscreteFairingPreferences | type[Defaults]


def preferences() -> Preferences:
    """The user's preferences, or the defaults."""
    entry = current_context().preferences.addons.get(__package__)
    return entry.preferences if entry is not None and entry.preferences is not None else Defaults


@dataclass(frozen=True)
class OfRuns:
    """The preferences that runs need, as a value that other threads may read."""

    memory_limit: int  # megabytes
    threads: int


def of_runs() -> OfRuns:
    now = preferences()
    return OfRuns(memory_limit=now.memory_limit, threads=now.threads)


def give_scenes_default_levels(*_: Any) -> None:
    """Gives scenes whose levels are unset the user's default."""
    for scene in all_scenes():
        _give_default_levels(scene)


def _give_default_levels(scene: Scene, _depsgraph: Any = None) -> None:
    """The same for a scene that was added later, at its first update."""
    settings, levels = scene.discrete_fairing, preferences().levels
    chosen = settings.is_property_set("levels") or settings.levels == levels
    if scene.library is None and not chosen:
        settings.levels = levels


HANDLERS = {"load_post": give_scenes_default_levels, "depsgraph_update_post": _give_default_levels}


TIMERS = (give_scenes_default_levels,)


def register() -> None:
    # the file that is open now: bpy.data may not be touched while add-ons are being enabled.
    # Without a window no timer ever runs, and one that waits would keep the bpy module from ending.
    if not bpy.app.background:
        events.start_timer(give_scenes_default_levels, 0.0)
