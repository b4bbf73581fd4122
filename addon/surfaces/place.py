# SPDX-License-Identifier: GPL-3.0-or-later
"""The transform of a surface: that of its source, until the user moves the surface.

The source's transform is stored with the surface. Location, rotation and scale each follow as long as
the surface still has the stored value.
"""

from collections.abc import Mapping
from typing import Any

from .. import memory
from ..blender import Context, Object
from ..mesh.object import PARENT, PLACE, TURN, copy_place

_PARTS = (("location", "delta_location"), TURN, ("scale", "delta_scale"))


def note(source: Object, target: Object) -> None:
    """Stores the transform that a surface has just got from its source."""
    _keep(source, target, PLACE)


def moved(target: Object) -> bool:
    """Whether the source of a surface has moved since, and the surface must follow."""
    return bool(_due(target))


def next_of(source: Object, target: Object | None) -> Object:
    """The next surface's transform: of the source if it is new or follows in all parts."""
    if target is None:
        return source
    stood = memory.recall(target, "stood") or {}
    whole = moved(target) and _following(target, stood) == set(PLACE)
    return source if whole else target


def follow(context: Context | None, target: Object) -> bool:
    """Gives the surface its source's transform, as far as it follows; whether it had moved."""
    source, due = memory.source_of(target), _due(target)
    if source is None:
        return False
    follows = _following(target, memory.recall(target, "stood") or {})
    if due:
        own = {name: _plain(getattr(target, name)) for name in PLACE if name not in follows}
        copy_place(context, source, target)
        for name, value in own.items():
            setattr(target, name, value)
    if due or not memory.recall(target, "stood"):
        _keep(source, target, follows)
    return bool(due)


def _keep(source: Object, target: Object, follows: Any) -> None:
    """Parts that constraints change are not values of the source; the surface keeps its own there."""
    if source.constraints:
        known = _values(target)
        stood = {name: known[name] if name in follows else None for name in PLACE}
        stood |= {name: known[name] for name in PARENT}
    else:
        stood = _values(source)
    memory.keep(target, "stood", stood | {"seen": _seen(source)})


def _seen(source: Object) -> dict[str, Any]:
    world = {"world": _plain(source.matrix_world)} if source.constraints else {}
    return _values(source) | world


def _due(target: Object) -> bool:
    source, stood = memory.source_of(target), memory.recall(target, "stood")
    if source is None or not stood or not target.discrete_fairing.follow_transform:
        return False
    before, now = stood.get("seen"), _seen(source)
    if before == now or not isinstance(before, dict) or _hangs_on(source, target):
        return False
    follows = _following(target, stood)
    if source.constraints or any(before.get(name) != now[name] for name in PARENT):
        return bool(follows)
    return any(before.get(name) != now[name] for name in follows)


def _hangs_on(source: Any, target: Object) -> bool:
    """Whether the source moves with the surface, as its child."""
    while source is not None and source != target:
        source = source.parent
    return source is not None


def _following(target: Object, stood: Mapping[str, Any]) -> set[str]:
    """The parts of the transform that are still the source's; none with other parents."""
    now = _values(target)
    if any(now[name] != stood.get(name) for name in PARENT):
        return set()
    kept = [part for part in _PARTS if all(now[name] == stood.get(name) for name in part)]
    return {name for part in kept for name in part}


def _values(one: Object) -> dict[str, Any]:
    return {name: _plain(getattr(one, name)) for name in (*PARENT, *PLACE)}


def _plain(value: Any) -> Any:
    """The value as in JSON."""
    if value is None or isinstance(value, (str, int, float)):
        return value
    return value.name_full if hasattr(value, "name_full") else [_plain(part) for part in value]
