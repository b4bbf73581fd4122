# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows the control mesh of a live surface as wire, so that the surface is visible through it."""

from collections.abc import Iterable
from typing import Any, Literal, cast

import bpy

from ..blender import Object
from ..memory import source_of

_WIRE: Literal["WIRE"] = "WIRE"
_KINDS = cast(Any, bpy.types.Object.bl_rna.properties["display_type"]).enum_items.keys()


def show(target: Object) -> None:
    """Shows it as wire; its previous display is stored with `target`."""
    source, live = source_of(target), target.discrete_fairing_live
    if source is None or not live.cage_as_wire or _is_linked(source, target):
        return
    if source.display_type != _WIRE:
        live.cage_display = source.display_type
        source.display_type = _WIRE


def restore(target: Object, others: Iterable[Object] = ()) -> None:
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
