# SPDX-License-Identifier: GPL-3.0-or-later
"""Handlers and the timer: the only place where Blender calls live surfaces.

All are registered with the add-on and return at once while nothing is live: taking a handler away from within another
would make Blender skip one of somebody else's. Without a window no timer ever runs, so there is none.
"""

import bpy
from bpy.app.handlers import persistent

from . import registry
from .reference import key

INTERVAL = 0.1  # seconds between two looks at what waits

_rendering = False


def wake():
    """Starts the timer, for a session that was just added."""
    if not bpy.app.background and not bpy.app.timers.is_registered(tick):
        bpy.app.timers.register(tick, first_interval=INTERVAL)


def tick():
    """Ends what has lost its objects, follows settings, whose change Blender does not announce, and sees to full levels.

    As a timer: the seconds until the next look.
    """
    if _rendering:
        return INTERVAL
    for session in registry.sessions():
        _attempt(session, _advance)
    _redraw()
    return INTERVAL if registry.sessions() else None


def look_at(session):
    """The first surface of a session, without waiting for a change."""
    _attempt(session, lambda it: it.follow(bpy.context.evaluated_depsgraph_get()))


def complete(session, context):
    """The full level now if it is due, and the end."""
    _attempt(session, lambda it: it.complete(context))
    if session in registry.sessions():
        registry.remove(session)


def _advance(session):
    if session.needs_look():
        session.follow(bpy.context.evaluated_depsgraph_get())
    session.advance(bpy.context)
    if session.ending and not session.is_waiting:
        registry.remove(session)


def _attempt(session, step):
    """An error must not stop Blender's timer, nor come again with each redraw: it ends the session and is told."""
    gone = session.why_gone()
    if gone:
        registry.remove(session, gone)
        return
    try:
        with registry.quiet():
            step(session)
    except Exception as error:
        registry.remove(session, f"Live has ended by an unexpected error, please report it: {error!r}")
        raise


@persistent
def _follow(_scene, depsgraph):
    if not registry.sessions() or registry.is_quiet() or _rendering:
        return
    reshaped = {key(change.id.original) for change in depsgraph.updates if change.is_updated_geometry}

    def step(session):
        if session.needs_look(reshaped):
            session.follow(depsgraph)

    for session in registry.sessions():
        _attempt(session, step)


@persistent
def _before_undo(*_):
    for session in registry.sessions():
        session.cancel_full(wait=True)


@persistent
def _distrust_all(*_):
    for session in registry.sessions():
        session.distrust()


@persistent
def _render_begins(*_):
    global _rendering
    _rendering = True


@persistent
def _render_ends(*_):
    """May come on another thread: the timer does the rest."""
    global _rendering
    _rendering = False
    _distrust_all()


@persistent
def _end_all(*_):
    """Before another file is loaded: nothing of this one may be touched any more."""
    global _rendering
    _rendering = False
    registry.clear()
    if bpy.app.timers.is_registered(tick):
        bpy.app.timers.unregister(tick)


def _redraw():
    """The sidebars, which show how long updates take."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


_HANDLERS = {
    "depsgraph_update_post": _follow,
    "undo_pre": _before_undo,
    "redo_pre": _before_undo,
    "undo_post": _distrust_all,
    "redo_post": _distrust_all,
    "render_init": _render_begins,
    "render_complete": _render_ends,
    "render_cancel": _render_ends,
    "load_pre": _end_all,
}


def register():
    for name, handler in _HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister():
    _end_all()
    for name, handler in _HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(handler)
