# SPDX-License-Identifier: GPL-3.0-or-later
"""One handler for each of Blender's events, with any number of listeners in the add-on; and timers.

Handlers stay while the add-on is enabled, even when other files are opened: if a handler removed one
inside another handler, Blender would skip an unrelated one.
"""

import traceback
from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import bpy
from bpy.app.handlers import persistent

Listener: TypeAlias = Callable[..., None]

_listeners: dict[str, list[Listener]] = {}
_handlers: dict[str, Listener] = {}


def listen(wanted: Mapping[str, Listener]) -> None:
    """Listens to these events of bpy.app.handlers, in the order of registration."""
    for name, listener in wanted.items():
        if name not in _handlers:
            _handlers[name] = _relay(name)
            getattr(bpy.app.handlers, name).append(_handlers[name])
        _listeners.setdefault(name, []).append(listener)


def ignore(wanted: Mapping[str, Listener]) -> None:
    """Stops listening; an event's handler is removed with its last listener."""
    for name, listener in wanted.items():
        _listeners[name].remove(listener)
        if not _listeners[name]:
            getattr(bpy.app.handlers, name).remove(_handlers.pop(name))


def start_timer(function: Callable[[], float | None], seconds: float) -> None:
    """Calls `function` after so many seconds, unless a call is pending already."""
    if not bpy.app.timers.is_registered(function):
        bpy.app.timers.register(function, first_interval=seconds)


def stop_timer(function: Callable[[], float | None]) -> None:
    if bpy.app.timers.is_registered(function):
        bpy.app.timers.unregister(function)


def _relay(name: str) -> Listener:
    @persistent
    def tell(*arguments: Any) -> None:
        for listener in tuple(_listeners[name]):
            try:
                listener(*arguments)
            except Exception:  # like Blender: an error in one does not stop the others
                traceback.print_exc()

    return tell
