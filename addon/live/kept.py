# SPDX-License-Identifier: GPL-3.0-or-later
"""Live stored in the file: noted when it is saved, switched on when it is opened."""

from typing import Any

import bpy

from ..blender import Object, all_objects
from . import cage, registry, switch


def _note(*_: Any) -> None:
    """Notes which surfaces are live before the file is written, and returns their own shape keys to
    them.
    """
    for session in registry.sessions():
        session.lend()
    for target in _surfaces():
        registry.note(target, switch.is_on(target))


def _restore(*_: Any) -> None:
    """Switches on the live surfaces of the opened file. Objects that cannot be live stay unchanged;
    without a window all do, except for renders.
    """
    for target in _surfaces():
        live = target.discrete_fairing_live
        wanted = live.was_on and live.keep_on
        if wanted and (live.in_renders or not bpy.app.background):
            switch.switch_on(target)
        if not switch.is_on(target):
            cage.restore(target)


def _surfaces() -> list[Object]:
    return [
        o
        for o in all_objects()
        if o.type == "MESH" and o.library is None and o.discrete_fairing.source is not None
    ]


HANDLERS = {"save_pre": _note, "load_post": _restore}
