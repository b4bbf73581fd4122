# SPDX-License-Identifier: GPL-3.0-or-later
"""Live on and off, and which surfaces are meant."""

import bpy

from .. import native
from . import registry, watch
from .reference import is_in_a_scene, key
from .session import Session


def why_not(target):
    """Why this object cannot be live, in one sentence; empty if it can."""
    if native.why_missing():
        return native.why_missing()
    source = target.discrete_fairing.source if target.type == "MESH" else None
    if source is None:
        return "Select a faired surface whose source still exists"
    if any(block.library or block.override_library for block in (target, target.data)):
        return "A linked object cannot be changed"
    if any(block.library for block in (source, source.data)):
        return "The source is linked from another file: nothing can be edited here"
    return ""


def is_on(target):
    session = registry.session_of(target)
    return session is not None and not session.ending


def switch_on(target):
    """Makes a faired object follow its source; nothing happens if it does, or cannot."""
    session = registry.session_of(target)
    if session is not None:
        session.ending = False
        return
    if why_not(target):
        return
    session = Session(target)
    registry.add(session)
    watch.look_at(session)
    watch.wake()


def switch_off(target, context):
    """Ends it once the full level is there: in a window that comes by itself, otherwise at once."""
    session = registry.session_of(target)
    if session is None:
        return
    session.ending = True
    if bpy.app.background:
        watch.complete(session, context)


def surfaces_at_hand(context):
    """The faired objects that the active object stands for: itself, or what is made of it (all live ones, else the last)."""
    active = context.active_object
    if active is None or active.type != "MESH":
        return []
    if active.discrete_fairing.source is not None:
        return [active]
    return live_surfaces_of(active) or _surfaces_of(active)[-1:]


def live_surfaces_of(source):
    """The live surfaces that follow `source`."""
    pairs = [session.objects() for session in registry.sessions() if not session.ending]
    return [target for its, target in pairs if target is not None and its == source]


def _surfaces_of(source):
    made = [o for o in bpy.data.objects if o.type == "MESH" and o.discrete_fairing.source == source]
    return sorted((o for o in made if not why_not(o) and is_in_a_scene(o)), key=lambda o: _age(key(o)))


def _age(identity):
    """Session ids grow with time; names do not."""
    return identity if isinstance(identity, int) else 0
