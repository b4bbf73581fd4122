# SPDX-License-Identifier: GPL-3.0-or-later
"""Redraws parts of the window after changes that Blender does not notice."""

from collections.abc import Hashable
from time import monotonic
from typing import Any

from .blender import Context

INTERVAL = 0.2  # least seconds between two redraws during a run


def tag_sidebars(context: Context) -> None:
    """Redraws the sidebars of all viewports, but not the viewports, which may be slow."""
    for area in _viewports(context):
        for region in area.regions:
            if region.type == "UI":
                region.tag_redraw()


def tag_viewports(context: Context) -> None:
    """Redraws whole viewports."""
    for area in _viewports(context):
        area.tag_redraw()


def _viewports(context: Context) -> list[Any]:
    areas = (area for window in context.window_manager.windows for area in window.screen.areas)
    return [area for area in areas if area.type == "VIEW_3D"]


class Progress:
    """Limits how often a changing value is redrawn."""

    def __init__(self) -> None:
        self._shown: Hashable = None
        self._at = 0.0

    def is_due(self, now: Hashable) -> bool:
        """Whether to redraw for the value `now`: it is new, and the last redraw was some time ago."""
        if now == self._shown or monotonic() - self._at < INTERVAL:
            return False
        self._shown, self._at = now, monotonic()
        return True
