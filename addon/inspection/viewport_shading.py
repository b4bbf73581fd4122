# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading of a viewport that shows what is inspected, and the way back.

What it was before is kept while Blender runs.
"""

from typing import Any

from . import overlay
from .display import VALUES

_before: dict[int, tuple[str, str]] = {}  # viewport: its shading and colours


def shows(space: Any, mode: str) -> bool:
    """Whether the viewport `space` shows objects in a `mode` of inspection; others have no shading."""
    shading = getattr(space, "shading", None)
    if mode == "NONE" or shading is None or shading.type in {"MATERIAL", "RENDERED"}:
        return True
    if mode not in VALUES:
        return overlay.is_on()
    return shading.type == "SOLID" and shading.color_type == "VERTEX"


def show(space: Any, mode: str) -> None:
    """Switches the viewport `space` if it does not show `mode`; back, if that is NONE."""
    if mode == "NONE":
        _restore(space)
    elif not shows(space, mode):
        # from one mode to the next, what was before the first one counts
        _before.setdefault(space.as_pointer(), (space.shading.type, space.shading.color_type))
        switch(space, "ATTRIBUTE" if mode in VALUES else "MATERIAL")


def switch(space: Any, shading: str) -> None:
    """To MATERIAL preview, or Solid by colour ATTRIBUTE."""
    space.shading.type = "MATERIAL" if shading == "MATERIAL" else "SOLID"
    if shading == "ATTRIBUTE":
        space.shading.color_type = "VERTEX"


def _restore(space: Any) -> None:
    before = _before.pop(space.as_pointer(), None)
    if before is not None:
        space.shading.type, space.shading.color_type = before
