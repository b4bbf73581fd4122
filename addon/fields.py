# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's properties by kind: name, tooltip and default come first; `more` is what bpy.props takes."""

from math import pi
from typing import Any

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty


def switch(name: str, description: str, default: bool = False, **more: Any) -> Any:
    return BoolProperty(name=name, description=description, default=default, **more)


def whole(name: str, description: str, default: int = 0, **more: Any) -> Any:
    return IntProperty(name=name, description=description, default=default, **more)


def number(name: str, description: str, default: float = 0.0, **more: Any) -> Any:
    return FloatProperty(name=name, description=description, default=default, **more)


def factor(name: str, description: str, default: float = 0.0, **more: Any) -> Any:
    """From 0 to 1."""
    return number(name, description, default, min=0.0, max=1.0, subtype="FACTOR", **more)


def length(name: str, description: str, default: float = 0.0, **more: Any) -> Any:
    """0 or more, in scene units."""
    return number(name, description, default, min=0.0, subtype="DISTANCE", **more)


def angle(name: str, description: str, default: float, **more: Any) -> Any:
    """From 0 to 180°, in radians."""
    return number(name, description, default, min=0.0, max=pi, subtype="ANGLE", **more)


def text(name: str, description: str, **more: Any) -> Any:
    return StringProperty(name=name, description=description, **more)


def hidden(name: str, description: str) -> Any:
    """A text that no panel shows."""
    return text(name, description, options={"HIDDEN"})


def choice(name: str, description: str, items: Any, default: Any = None, **more: Any) -> Any:
    """One of `items`, the first by default."""
    chosen = {} if default is None else {"default": default}
    return EnumProperty(name=name, description=description, items=items, **chosen, **more)
