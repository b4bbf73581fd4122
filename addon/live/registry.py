# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfaces that are live. It exists while Blender runs: files do not keep it."""

from contextlib import contextmanager

from .reference import key

_sessions = {}  # target key: Session
_endings = {}  # target key: why it ended by itself, a sentence
_quiet = 0


def sessions():
    """All of them, as a list that may be changed behind."""
    return list(_sessions.values())


def session_of(target):
    """The Session of a faired object, or None."""
    return _sessions.get(key(target))


def add(session):
    _sessions[session.key] = session
    _endings.pop(session.key, None)


def remove(session, reason=""):
    """Ends a session; `reason` if it was not switched off."""
    session.cancel_full(wait=True)
    _sessions.pop(session.key, None)
    if reason:
        _endings[session.key] = reason


def clear():
    """Ends all."""
    for session in sessions():
        remove(session)
    _endings.clear()


def why_ended(target):
    """Why the surface is not live any more, a sentence; empty if it never was or was switched off."""
    return _endings.get(key(target), "")


@contextmanager
def quiet():
    """Inside the `with`, what changes is our own doing."""
    global _quiet
    _quiet += 1
    try:
        yield
    finally:
        _quiet -= 1


def is_quiet():
    return _quiet > 0
