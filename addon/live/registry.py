# SPDX-License-Identifier: GPL-3.0-or-later
"""The live surfaces. They exist while Blender runs and are not stored in files. Their control meshes are shown as wire, so
that the surfaces are visible through them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Literal, cast

import bpy

from ..blender import Object
from ..memory import source_of, source_problem
from ..mesh.object import Reference, session_key

if TYPE_CHECKING:
    from .session import Session


_sessions: dict[int, Session] = {}  # target key: Session
_endings: dict[int, str] = {}  # target key: why it ended by itself, a sentence
_known: dict[int, Reference] = {}  # surfaces that are or were live since the file was opened
_ignoring = 0


def is_in_a_scene(target: Object) -> bool:
    """Whether the object is in a scene: a deleted one remains while other data refer to it."""
    return any(scene.objects.get(target.name) == target for scene in bpy.data.scenes)


def why_gone(source: Object | None, target: Object | None) -> str:
    """Why a surface can no longer follow its source, a sentence; empty if it can."""
    if target is None or not is_in_a_scene(target):
        return "The surface was deleted: Live has ended"
    if source_problem(target):
        return f"{source_problem(target)}. Live has ended"
    gone = source is None or not is_in_a_scene(source)
    return "The source was deleted: Live has ended" if gone else ""


def sessions() -> list[Session]:
    """All sessions, as a list that stays valid while sessions end."""
    return list(_sessions.values())


def session_of(target: Object) -> Session | None:
    return _sessions.get(session_key(target))


def known() -> list[Object]:
    """The existing surfaces that are or were live since the file was opened."""
    return [target for one in _known.values() if (target := one.find()) is not None]


def add(session: Session) -> None:
    _sessions[session.key] = session
    _endings.pop(session.key, None)
    target = session.objects()[1]
    if target is not None:
        _known[session.key] = Reference(target)
        note(target, True)
        show_cage(target)


def note(target: Object, on: bool) -> None:
    """Stores in the file, and so in undo steps, whether `target` is live."""
    if target.discrete_fairing_live.was_on != on:
        target.discrete_fairing_live.was_on = on


def remove(session: Session, reason: str = "", hand_back: bool = True) -> None:
    """Ends a session; `reason`: why by itself; `hand_back`: the surface has the mesh written."""
    session.cancel_full(wait=True)
    session.release(hand_back)
    _sessions.pop(session.key, None)
    target = session.objects()[1]
    if target is not None:
        note(target, False)
        others = [other.objects()[1] for other in sessions()]
        restore_cage(target, [other for other in others if other is not None])
    if reason:
        _endings[session.key] = reason


def give_up(session: Session, reason: str) -> None:
    """Ends the session finally: undo does not restore it."""
    remove(session, reason)
    _known.pop(session.key, None)


def clear() -> None:
    for session in sessions():
        remove(session, hand_back=False)
    _endings.clear()
    _known.clear()


def why_ended(target: Object) -> str:
    """Why the surface is no longer live, a sentence; empty if it never was or was switched off."""
    return _endings.get(session_key(target), "")


@contextmanager
def ignoring_updates() -> Iterator[None]:
    """A context for the add-on's own changes, which handlers must ignore."""
    global _ignoring
    _ignoring += 1
    try:
        yield
    finally:
        _ignoring -= 1


def ignores_updates() -> bool:
    return _ignoring > 0


_WIRE: Literal["WIRE"] = "WIRE"
_KINDS = cast(Any, bpy.types.Object.bl_rna.properties["display_type"]).enum_items.keys()


def show_cage(target: Object) -> None:
    """Shows it as wire; its previous display is stored with `target`."""
    source, live = source_of(target), target.discrete_fairing_live
    if source is None or not live.cage_as_wire or _is_linked(source, target):
        return
    if source.display_type != _WIRE:
        live.cage_display = source.display_type
        source.display_type = _WIRE


def restore_cage(target: Object, others: Iterable[Object] = ()) -> None:
    """Restores its display, unless the user has changed it; `others`: surfaces still live."""
    source, live = source_of(target), target.discrete_fairing_live
    if source is None or not live.cage_display or _is_linked(source, target):
        return
    before, live.cage_display = live.cage_display, ""
    heir = next((o for o in others if o != target and source_of(o) == source), None)
    if heir is not None and heir.discrete_fairing_live.cage_as_wire:
        heir.discrete_fairing_live.cage_display = before
    elif source.display_type == _WIRE and before in _KINDS:  # files may contain any text
        source.display_type = cast(Any, before)


def _is_linked(*objects: Object) -> bool:
    return any(each.library is not None for each in objects)
