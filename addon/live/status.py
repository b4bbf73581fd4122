# SPDX-License-Identifier: GPL-3.0-or-later
"""What a live surface is doing, in words that fit the sidebar."""

from ..request.size import count_text
from . import registry


def lines(target):
    """A few short lines; empty if `target` is not live."""
    session = registry.session_of(target)
    if session is None:
        return []
    found = []
    if session.triangles:
        found.append(f"Level {session.level}: {count_text(session.triangles)}")
        found.append(f"Last update: {sum(session.parts.values()):.1f} ms")
    found += session.slower
    if session.full_text:
        found.append(f"Full level: {session.full_text}")
    return found


def problem(target):
    """Why `target` does not follow, or does not any more, a sentence; empty if all is well."""
    session = registry.session_of(target)
    return session.trouble if session is not None else registry.why_ended(target)
