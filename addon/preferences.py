# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences, which apply to all files of a user."""

from dataclasses import dataclass
from typing import TypeAlias

import bpy

from .blender import Context, current_context
from .fields import text, whole


class Defaults:
    """The values if the add-on is imported without being installed, as in tests."""

    memory_limit = 0
    threads = 0
    speeds = "{}"


class DiscreteFairingPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    memory_limit: whole(
        "Memory Limit (MB)",
        "Refuses runs that need more megabytes than this; 0: three quarters of the memory",
        Defaults.memory_limit,
        min=0,
        soft_max=65536,
    )
    threads: whole(
        "Threads",
        "How many processor cores a run may use, or 0 for all; the surface is the same for any number",
        Defaults.threads,
        min=0,
        max=1024,
    )

    speeds: text(
        "Speeds",
        "Seconds a triangle of this machine's last runs, by fairness, as JSON",
        default=Defaults.speeds,
        options={"HIDDEN"},
    )

    def draw(self, _context: Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("memory_limit", "threads"):
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
