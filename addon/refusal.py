# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that say why they are grey."""


class Refusing:
    """Mixin of operators with `why_not(context)`: why they cannot run, in one sentence; empty when they can."""

    @classmethod
    def poll(cls, context):
        reason = cls.why_not(context)
        if reason:
            cls.poll_message_set(reason)
        return not reason
