# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators whose grey buttons state the reason."""

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

# why an operator cannot run in a context, in one sentence; empty if it can
Reason: TypeAlias = Callable[[Any], str]

LINKED = (
    "Make it local first (Object > Relations > Make Local): this mesh is linked from another file"
)
LINKED_SURFACE = (
    "Make it local first (Object > Relations > Make Local): a linked object cannot be changed"
)


class ExplainedPoll:
    """Mix-in of operators with `reasons` against running; the first becomes the tooltip."""

    reasons: tuple[Reason, ...]
    bl_options: Any = {"REGISTER", "UNDO"}

    if TYPE_CHECKING:  # Blender's own method

        @classmethod
        def poll_message_set(cls, message: str) -> None: ...

    @classmethod
    def poll(cls, context: Any) -> bool:
        reason = first_reason(context, cls.reasons)
        if reason:
            cls.poll_message_set(reason)
        return not reason


def first_reason(context: Any, reasons: Iterable[Reason]) -> str:
    """The sentence of the first reason that applies; empty if none does."""
    return next(filter(None, (reason(context) for reason in reasons)), "")


def needs(found: Callable[[Any], object], sentence: str) -> Reason:
    """A reason with this `sentence` that applies if `found(context)` is empty."""
    return lambda context: "" if found(context) else sentence


def in_mode(sentence: str, *modes: str) -> Reason:
    """A reason with this `sentence` that applies in other modes than `modes`."""
    return lambda context: "" if context.mode in modes else sentence


def of_meshes(targets: Callable[[Any], Sequence[Any]]) -> Reason:
    """A reason that applies if the mesh objects `targets(context)` cannot be worked on."""
    return lambda context: mesh_reason(targets(context))


def mesh_reason(targets: Sequence[Any]) -> str:
    """Why mesh objects cannot be worked on, in one sentence; empty if they can."""
    if not targets:
        return "Select a mesh object first"
    return LINKED if any(t.library or t.data.library for t in targets) else ""


IN_OBJECT_MODE = in_mode("Press Tab first: this works in Object Mode", "OBJECT")
IN_EITHER_MODE = in_mode("Go to Object Mode or Edit Mode first", "OBJECT", "EDIT_MESH")


def in_edit_mode(chosen: str) -> tuple[Reason, ...]:
    """Reasons that require meshes in Edit Mode; `chosen`: the plural of what must be selected."""
    return (
        in_mode(f"Press Tab first: {chosen} are chosen in Edit Mode", "EDIT_MESH"),
        of_meshes(lambda context: context.objects_in_mode_unique_data),
    )
