# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn again when something has changed that Blender does not know of."""

from collections.abc import Hashable
from time import monotonic

from .blender import Context

INTERVAL = 0.2  # seconds between two drawings of something that goes on


def tag_sidebars(context: Context) -> None:
    """The sidebars of all viewports; not the viewports themselves, which may be slow."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


def tag_outliners(context: Context) -> None:
    """Their headers, where surfaces that are out of date are counted."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "OUTLINER":
                area.tag_redraw()


class Progress:
    """When to draw what changes all the time: not too often."""

    def __init__(self) -> None:
        self._shown: Hashable = None
        self._at = 0.0

    def is_due(self, now: Hashable) -> bool:
        """Whether `now` is to be drawn: it is new, and the last drawing is a while ago."""
        if now == self._shown or monotonic() - self._at < INTERVAL:
            return False
        self._shown, self._at = now, monotonic()
        return True
