# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers the declarations of modules in Blender.

Classes are found without a declaration. `ATTACHED`: property groups of data-blocks. `HANDLERS`:
listeners by the names of Blender's events. `TIMERS`: functions that may be waiting for a timer. A
module may have functions `register` and `unregister` for the rest, called after these are registered
and before they are unregistered.
"""

from types import ModuleType
from typing import Any

import bpy
from bpy.props import PointerProperty

from . import events

_KINDS = (
    bpy.types.AddonPreferences,
    bpy.types.FileHandler,
    bpy.types.Menu,
    bpy.types.Operator,
    bpy.types.Panel,
    bpy.types.PropertyGroup,
)


def classes_of(module: ModuleType) -> list[type]:
    """The classes of `module` that Blender registers, in their order."""
    defined = [v for v in vars(module).values() if getattr(v, "__module__", "") == module.__name__]
    return [v for v in defined if isinstance(v, type) and issubclass(v, _KINDS)]


def register(module: ModuleType) -> None:
    own = vars(module)
    make_property: Any = PointerProperty  # its stub returns None
    for each in classes_of(module):
        bpy.utils.register_class(each)
    for owner, name, group in own.get("ATTACHED", ()):
        setattr(owner, name, make_property(type=group))
    events.listen(own.get("HANDLERS", {}))
    if "register" in own:
        own["register"]()


def unregister(module: ModuleType) -> None:
    own = vars(module)
    if "unregister" in own:
        own["unregister"]()
    for timer in own.get("TIMERS", ()):
        events.stop_timer(timer)
    events.ignore(own.get("HANDLERS", {}))
    for owner, name, _ in own.get("ATTACHED", ()):
        delattr(owner, name)
    for each in reversed(classes_of(module)):
        bpy.utils.unregister_class(each)
