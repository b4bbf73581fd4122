# SPDX-License-Identifier: GPL-3.0-or-later
"""Handlers and the timer: the only place where Blender calls live surfaces.

All are registered with the add-on and return at once if nothing is live: if a handler removed one
inside another handler, Blender would skip an unrelated one. Without a window no timer ever runs, so
there is none.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Iterable
from typing import TYPE_CHECKING, Any

import bpy

from .. import errors, events
from ..blender import Context, Object, Scene, current_context
from ..errors import JobError
from ..mesh.object import changed_keys
from ..redraw import Progress, tag_sidebars
from ..surfaces import curve_cage
from . import registry
from .registry import session_key

if TYPE_CHECKING:
    from .session import Session

INTERVAL = 0.1  # seconds between two checks

_rendering = False
_locked = False  # whether windows do not draw during renders
_progress = Progress()


def start_timer() -> None:
    """Starts the timer, for a session that was just added."""
    if not bpy.app.background:
        events.start_timer(on_timer, INTERVAL)


def on_timer() -> float | None:
    """Ends sessions that have lost their objects, follows settings, whose changes Blender does not
    report, and advances full levels.

    As a timer: returns the seconds until the next call.
    """
    if _rendering:
        return INTERVAL
    for session in registry.sessions():
        guarded(session, _advance)
    if _progress.is_due(tuple(map(_shown, registry.sessions()))):
        tag_sidebars(current_context())
    return INTERVAL if registry.sessions() else None


def _shown(session: Session) -> tuple[Hashable, ...]:
    """The text that the panel shows, to detect changes."""
    return session.key, session.updates, session.level, session.full_text, session.trouble


def look_at(session: Session) -> None:
    """Makes the first surface of a session, without waiting for a change."""
    guarded(session, lambda it: it.follow())


def complete(session: Session, context: Context) -> None:
    """Computes the full level now if it is due, and ends the session if it is to end."""
    guarded(session, lambda it: it.complete(context))
    if session in registry.sessions():
        registry.remove(session)


def _advance(session: Session) -> None:
    session.stand()
    if session.needs_look():
        session.follow()
    session.advance(current_context())
    if session.ending and not session.is_waiting:
        registry.remove(session)


def guarded(session: Session, step: Callable[[Session], object]) -> None:
    """Runs a step; an error ends the session and is reported, and must not stop the timer."""
    gone = session.why_gone()
    if gone:
        registry.remove(session, gone)
        return
    try:
        with registry.ignoring_updates():
            step(session)
    except Exception as error:
        registry.give_up(
            session, f"Live has ended because of an unexpected error, please report it: {error!r}"
        )
        raise


def _follow(_scene: Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if not registry.sessions() or registry.ignores_updates():
        return
    reshaped = changed_keys(depsgraph, moved=False)
    moved = changed_keys(depsgraph, moved=True)
    reshaped |= _refreshed(filter(_is_awake, registry.sessions()), moved)

    def step(session: Session) -> None:
        session.stand()
        if session.needs_look(reshaped, moved):
            session.follow(depsgraph)

    for session in registry.sessions():
        if _is_awake(session):
            guarded(session, step)


def _follow_frame(_scene: Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Follows shape keys, armatures and drivers, whose changes Blender does not all report."""
    if registry.ignores_updates():
        return

    def step(session: Session) -> None:
        session.stand()
        session.follow(depsgraph)
        if bpy.app.background and not _rendering:  # no timer runs later
            session.follow_unseen()

    for session in registry.sessions():
        if _is_awake(session):
            guarded(session, step)


def _is_awake(session: Session) -> bool:
    """Whether a session follows changes. During a render only those do for which the user wants it, and
    only if no window draws, since drawing a mesh that is being written may crash.
    """
    target = session.objects()[1]
    wanted = target is not None and target.discrete_fairing_live.in_renders
    return not _rendering or (_locked and wanted)


def _before_undo(*_: Any) -> None:
    for session in registry.sessions():
        session.cancel_full(wait=True)


def _mark_all_stale(*_: Any) -> None:
    for session in registry.sessions():
        session.mark_stale()


def _render_begins(scene: Scene | None = None, *_: Any) -> None:
    global _rendering, _locked
    _locked = bpy.app.background or (scene is not None and scene.render.use_lock_interface)
    _rendering = True


def _render_ends(*_: Any) -> None:
    """May be called on another thread; the timer does the rest."""
    global _rendering
    _rendering = False
    _mark_all_stale()


def _end_all(*_: Any) -> None:
    """Before another file is loaded: data of this one must not be used any more."""
    global _rendering
    _rendering = False
    registry.clear()
    events.stop_timer(on_timer)


def _refreshed(sessions: Iterable[Session], changed: Collection[int]) -> set[int]:
    """Keys of the control meshes updated because one of their curves is among `changed`."""
    found: dict[int, str] = {}  # control mesh: why it could not be updated
    for session in sessions:
        source = session.objects()[0]
        if source is None or not curve_cage.is_cage(source):
            continue
        key = session_key(source.data)
        if key not in found and not curve_cage.keys(curve_cage.watched(source)).isdisjoint(changed):
            found[key] = _followed(source)
        if found.get(key):
            session.wait(found[key])
    return {key for key, trouble in found.items() if not trouble}


def _followed(cage: Object) -> str:
    try:
        with registry.ignoring_updates(), errors.explained(cage.name):
            curve_cage.follow(cage)
    except JobError as error:
        return str(error)
    return ""


HANDLERS = {
    "depsgraph_update_post": _follow,
    "frame_change_post": _follow_frame,
    "undo_pre": _before_undo,
    "redo_pre": _before_undo,
    "undo_post": _mark_all_stale,
    "redo_post": _mark_all_stale,
    "render_init": _render_begins,
    "render_complete": _render_ends,
    "render_cancel": _render_ends,
    "load_pre": _end_all,
}


def unregister() -> None:
    _end_all()
