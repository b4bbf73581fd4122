# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender tells of: one handler for each of its events, whoever of us listens; and timers.

They stay while the add-on is on, other files are opened included: taking a handler away from within
another would make Blender skip one of somebody else's.
"""

import traceback
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, TypeAlias

import bpy
from bpy.app.handlers import persistent

from .blender import Registration

Listener: TypeAlias = Callable[..., None]

_listeners: dict[str, list[Listener]] = {}
_handlers: dict[str, Listener] = {}


def listen(wanted: Mapping[str, Listener]) -> None:
    """From now on the events by these names, of bpy.app.handlers, are told; in the order of calls."""
    for name, listener in wanted.items():
        if name not in _handlers:
            _handlers[name] = _relay(name)
            getattr(bpy.app.handlers, name).append(_handlers[name])
        _listeners.setdefault(name, []).append(listener)


def ignore(wanted: Mapping[str, Listener]) -> None:
    """Ends that; the last one of an event takes its handler along."""
    for name, listener in wanted.items():
        _listeners[name].remove(listener)
        if not _listeners[name]:
            getattr(bpy.app.handlers, name).remove(_handlers.pop(name))


def listening(wanted: Mapping[str, Listener]) -> Registration:
    """Of a module that does nothing but listen."""
    return partial(listen, wanted), partial(ignore, wanted)


def start_timer(function: Callable[[], float | None], seconds: float) -> None:
    """`function` is called in so many seconds, if it does not wait for a call already."""
    if not bpy.app.timers.is_registered(function):
        bpy.app.timers.register(function, first_interval=seconds)


def stop_timer(function: Callable[[], float | None]) -> None:
    """It waits no longer, if it did."""
    if bpy.app.timers.is_registered(function):
        bpy.app.timers.unregister(function)


def _relay(name: str) -> Listener:
    @persistent
    def tell(*arguments: Any) -> None:
        for listener in tuple(_listeners[name]):
            try:
                listener(*arguments)
            except Exception:  # as Blender does: the others still run
                traceback.print_exc()

    return tell
