# SPDX-License-Identifier: GPL-3.0-or-later
"""Switches a viewport's shading for inspection, and back; the previous one is stored with it."""

from contextlib import suppress
from typing import Any

import bpy
from bpy.props import StringProperty

_BEFORE = "discrete_fairing_before"  # custom property of a viewport's shading: its previous type


def shows(space: Any, mode: str) -> bool:
    """Whether `space` shows objects in a `mode` of inspection; only viewports have shading."""
    shading = getattr(space, "shading", None)
    return mode == "NONE" or shading is None or shading.type in {"MATERIAL", "RENDERED"}


def show(space: Any, mode: str) -> None:
    """Switches the viewport `space` if it does not show `mode`; for NONE, switches back."""
    if mode == "NONE":
        _restore(space)
    elif not shows(space, mode):
        setattr(space.shading, _BEFORE, space.shading.type)
        space.shading.type = "MATERIAL"


def _restore(space: Any) -> None:
    shading = getattr(space, "shading", None)
    before = getattr(shading, _BEFORE, "").split()
    if shading is None or not before:
        return
    setattr(shading, _BEFORE, "")
    with suppress(TypeError):  # files may contain any text
        shading.type = before[0]


def register() -> None:
    make_property: Any = StringProperty  # its stub returns None
    setattr(bpy.types.View3DShading, _BEFORE, make_property(options={"HIDDEN"}))


def unregister() -> None:
    delattr(bpy.types.View3DShading, _BEFORE)
