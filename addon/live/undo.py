# SPDX-License-Identifier: GPL-3.0-or-later
"""Undo includes Live: if the click that switched it on is undone, so is Live.

An undo step contains `was_on`, which follows the switch, but no session.
"""

from typing import Any

from .. import events
from . import registry, switch

_SOON = 0.0  # seconds; not within undo, before Blender has updated its objects


def _agree(*_: Any) -> None:
    """Ends sessions that undo has switched off. Writes nothing, since undo has restored the mesh."""
    for target in registry.known():
        session, was_on = registry.session_of(target), target.discrete_fairing_live.was_on
        if session is not None and not was_on and not session.ending:
            registry.remove(session, hand_back=False)
        elif was_on and not switch.is_on(target):
            events.start_timer(resume, _SOON)


def resume() -> None:
    """Starts sessions that undo or redo has switched on."""
    for target in registry.known():
        if target.discrete_fairing_live.was_on and registry.is_in_a_scene(target):
            switch.switch_on(target)


HANDLERS = {"undo_post": _agree, "redo_post": _agree}
TIMERS = (resume,)
