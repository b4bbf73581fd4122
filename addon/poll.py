# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that say why they are grey."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

LINKED = (
    "Make it local first (Object > Relations > Make Local): this mesh is linked from another file"
)


class ExplainedPoll:
    """Mixin of operators with `poll_reason(context)`: why they cannot run, in one sentence; empty
    when they can.
    """

    if TYPE_CHECKING:  # what the operator and Blender have

        @staticmethod
        def poll_reason(context: Any) -> str: ...

        @classmethod
        def poll_message_set(cls, message: str) -> None: ...

    @classmethod
    def poll(cls, context: Any) -> bool:
        reason = cls.poll_reason(context)
        if reason:
            cls.poll_message_set(reason)
        return not reason


def mesh_poll_reason(targets: Sequence[Any]) -> str:
    """Why mesh objects cannot be worked on, in one sentence; empty when they can."""
    if not targets:
        return "Select a mesh object first"
    return LINKED if any(t.library or t.data.library for t in targets) else ""


def object_mode_reason(context: Any, targets: Sequence[Any]) -> str:
    """The same of `targets` in Object Mode."""
    if context.mode != "OBJECT":
        return "Press Tab first: this works in Object Mode"
    return mesh_poll_reason(targets)


def edit_mode_reason(context: Any, chosen: str) -> str:
    """The same of the meshes in Edit Mode; `chosen`: what is selected there, in the plural."""
    if context.mode != "EDIT_MESH":
        return f"Press Tab first: {chosen} are chosen in Edit Mode"
    return mesh_poll_reason(context.objects_in_mode_unique_data)
