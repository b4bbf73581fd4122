# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading of a viewport that shows what is inspected, and the way back.

What it was before is kept with the viewport itself: it goes with it, and files have it.
"""

from contextlib import suppress
from typing import Any

import bpy
from bpy.props import StringProperty

from . import overlay
from .display import VALUES

_BEFORE = "discrete_fairing_before"  # of a viewport's shading: its type and colours


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
        if not getattr(space.shading, _BEFORE):
            setattr(space.shading, _BEFORE, f"{space.shading.type} {space.shading.color_type}")
        switch(space, "ATTRIBUTE" if mode in VALUES else "MATERIAL")


def switch(space: Any, shading: str) -> None:
    """To MATERIAL preview, or Solid by colour ATTRIBUTE."""
    space.shading.type = "MATERIAL" if shading == "MATERIAL" else "SOLID"
    if shading == "ATTRIBUTE":
        space.shading.color_type = "VERTEX"


def _restore(space: Any) -> None:
    shading = getattr(space, "shading", None)
    before = getattr(shading, _BEFORE, "").split()
    if shading is None or not before:
        return
    setattr(shading, _BEFORE, "")
    for name, value in zip(("type", "color_type"), before):
        with suppress(TypeError):  # files may hold any text
            setattr(shading, name, value)


def register() -> None:
    make_property: Any = StringProperty  # whose stub says None
    setattr(bpy.types.View3DShading, _BEFORE, make_property(options={"HIDDEN"}))


def unregister() -> None:
    delattr(bpy.types.View3DShading, _BEFORE)
