# SPDX-License-Identifier: GPL-3.0-or-later
"""Live stays on in a file that is saved and opened again, and follows the steps of undo.

An undo step contains `was_on`, which follows the switch, but no session.
"""

from typing import Any

from .. import events
from ..blender import Object, all_objects
from . import registry, switch


def _note(*_: Any) -> None:
    """Notes which surfaces are live before saving, and returns their own shape keys to them."""
    for session in registry.sessions():
        session.lend()
    for target in _surfaces():
        registry.note(target, switch.is_on(target))


def _restore(*_: Any) -> None:
    """Switches on the live surfaces of the opened file that are live in renders."""
    for target in _surfaces():
        live = target.discrete_fairing_live
        if live.was_on and live.in_renders:
            switch.switch_on(target)
        if not switch.is_on(target):
            registry.restore_cage(target)


def _surfaces() -> list[Object]:
    return [
        o
        for o in all_objects()
        if o.type == "MESH" and o.library is None and o.discrete_fairing.source is not None
    ]


def _agree(*_: Any) -> None:
    """Ends sessions that undo has switched off. Writes nothing, since undo has restored the mesh."""
    for target in registry.known():
        session, was_on = registry.session_of(target), target.discrete_fairing_live.was_on
        if session is not None and not was_on and not session.ending:
            registry.remove(session, hand_back=False)
        elif was_on and not switch.is_on(target):
            # not within undo, before Blender has updated its objects
            events.start_timer(resume, 0.0)


def resume() -> None:
    """Starts sessions that undo or redo has switched on."""
    for target in registry.known():
        if target.discrete_fairing_live.was_on and registry.is_in_a_scene(target):
            switch.switch_on(target)


HANDLERS = {"save_pre": _note, "load_post": _restore, "undo_post": _agree, "redo_post": _agree}
TIMERS = (resume,)
