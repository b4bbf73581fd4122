# SPDX-License-Identifier: GPL-3.0-or-later
"""Switches Live on and off, for button and scripts, and describes its state."""

from typing import Any

import bpy

from .. import core
from ..blender import Context, Object, all_objects, current_context
from ..fields import hidden, switch, text, whole
from ..memory import no_source_reason, source_of
from ..mesh.object import session_key
from ..poll import LINKED_SURFACE
from ..size import count_text
from . import handlers, registry
from .registry import is_in_a_scene
from .session import Session

DEFAULT_LEVELS = 3


def why_not(target: Object) -> str:
    """Why this object cannot be live, in one sentence; empty if it can."""
    if core.why_missing():
        return core.why_missing()
    source = source_of(target)
    if source is None:
        return no_source_reason(target)
    if any(block.library or block.override_library for block in (target, target.data)):
        return LINKED_SURFACE
    if any(block.library for block in (source, source.data)):
        return "Make the source local first (Object > Relations > Make Local): it is linked from another file"
    return ""


def is_on(target: Object) -> bool:
    session = registry.session_of(target)
    return session is not None and not session.ending


def is_seen_to(target: Object) -> bool:
    """Whether it follows its source, or its full level is still to come."""
    return registry.session_of(target) is not None


def switch_on(target: Object) -> None:
    """Makes a faired object follow its source; does nothing if it does already, or cannot."""
    session = registry.session_of(target)
    if session is not None:
        session.ending = False
        registry.note(target, True)
        return
    if why_not(target):
        return
    session = Session(target)
    registry.add(session)
    handlers.look_at(session)
    handlers.start_timer()


def switch_off(target: Object, context: Context) -> None:
    """Ends it once the full level is complete: in a window that happens later, otherwise at once."""
    session = registry.session_of(target)
    if session is None:
        return
    session.ending = True
    registry.note(target, False)
    if bpy.app.background:
        handlers.complete(session, context)


def active_surfaces(context: Context) -> list[Object]:
    """The active surface, or those made from the active object: all live ones, else the last."""
    active = context.active_object
    if active is None or active.type != "MESH":
        return []
    if active.discrete_fairing.source is not None:
        return [active]
    return live_surfaces_of(active) or surfaces_of(active)[-1:]


def live_surfaces_of(source: Object) -> list[Object]:
    pairs = [session.objects() for session in registry.sessions() if not session.ending]
    return [target for its, target in pairs if target is not None and its == source]


def look_again(source: Object) -> None:
    """Updates the live surfaces of `source` after changes that Blender does not report."""
    for target in live_surfaces_of(source):
        session = registry.session_of(target)
        if session is not None:
            session.mark_stale()


def surfaces_of(source: Object) -> list[Object]:
    """Surfaces made from `source` that can be recomputed, the newest last."""
    made = [o for o in all_objects() if o.type == "MESH" and o.discrete_fairing.source == source]
    made = [o for o in made if not why_not(o) and is_in_a_scene(o)]
    return sorted(made, key=session_key)  # which grow with time


def lines(target: Object) -> list[str]:
    """Short lines on its state; empty if `target` is not live."""
    session = registry.session_of(target)
    if session is None:
        return []
    found = []
    if session.triangles:
        found.append(f"Level {session.level}: {count_text(session.triangles)}")
        found.append(f"Last update: {1e3 * session.seconds:.1f} ms")
    found += session.slower
    if session.full_text:
        found.append(f"Full level: {session.full_text}")
    return found


def problem(target: Object) -> str:
    """Why `target` does not follow its source, or no longer does, a sentence; empty if it does."""
    session = registry.session_of(target)
    return session.trouble if session is not None else registry.why_ended(target)


def _switch(group: Any, value: Any) -> None:
    if value:
        switch_on(group.id_data)
    else:
        switch_off(group.id_data, current_context())


def _status(group: Any) -> str:
    said = problem(group.id_data)
    return "\n".join([*lines(group.id_data), *([said] if said else [])])


def _cage_changed(group: Any, _context: Context) -> None:
    target = group.id_data
    if not is_on(target):
        return
    if group.cage_as_wire:
        registry.show_cage(target)
    else:
        registry.restore_cage(target)


def _in_renders_changed(group: Any, _context: Context) -> None:
    """Locks the interface during renders, since drawing a mesh while a render writes it may crash."""
    for scene in group.id_data.users_scene if group.in_renders else ():
        if scene.library is None and not scene.render.use_lock_interface:
            scene.render.use_lock_interface = True


class FAIRING_PG_live(bpy.types.PropertyGroup):
    """How a faired object follows its source. Files store all except `on`."""

    on: switch(
        "Live",
        "The surface follows while its source is edited, until you switch this off or open a file",
        get=lambda group: is_on(group.id_data),
        set=_switch,
    )
    levels: whole(
        "Live Levels",
        "The level shown during an edit, at most the surface's own, and lower where updates would be slow",
        DEFAULT_LEVELS,
        min=1,
        max=10,
        soft_max=5,
    )
    in_renders: switch(
        "Live in Renders",
        "The surface follows frame by frame in renders too, at its Live Levels, and the window waits meanwhile. Live is on again when the file is opened",
        update=_in_renders_changed,
    )
    cage_as_wire: switch(
        "Cage as Wire",
        "Shows the source as wire while Live is on, so that the surface is visible",
        True,
        update=_cage_changed,
    )
    was_on: switch("Was On", "Live was on in this file, or this step of undo", options={"HIDDEN"})
    cage_display: hidden("Cage Display", "How the source was shown before Live was switched on")
    status: text("Status", "What Live is doing, or why it has ended", get=_status)


ATTACHED = ((bpy.types.Object, "discrete_fairing_live", FAIRING_PG_live),)
