# SPDX-License-Identifier: GPL-3.0-or-later
"""Undo takes Live along: what is undone with the click that switched it on is Live too.

A step of Blender's undo holds `was_on`, which follows the switch, but no session.
"""

from typing import Any

from .. import events
from . import registry, switch

_SOON = 0.0  # seconds; not from within undo, whose objects Blender has not looked at yet


def _agree(*_: Any) -> None:
    """Ends what is not to be on any more. Nothing is written: its mesh is what it was before."""
    for target in registry.known():
        session, was_on = registry.session_of(target), target.discrete_fairing_live.was_on
        if session is not None and not was_on and not session.ending:
            registry.remove(session, hand_back=False)
        elif was_on and not switch.is_on(target):
            events.start_timer(resume, _SOON)


def resume() -> None:
    """Switches on what is to be on again."""
    for target in registry.known():
        if target.discrete_fairing_live.was_on and registry.is_in_a_scene(target):
            switch.switch_on(target)


_HANDLERS = {"undo_post": _agree, "redo_post": _agree}


def register() -> None:
    events.listen(_HANDLERS)


def unregister() -> None:
    events.ignore(_HANDLERS)
    events.stop_timer(resume)
