# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a surface corresponds to its source and settings, whose state is stored with it.

Panels only look up the result. After a change a timer reads the source again; without a window that is
done on request. Data that are only carried along, such as UV maps, do not count.
"""

import zlib
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, fields
from typing import Any

import bpy
import numpy as np

from .. import events, memory
from ..blender import Context, Object, Scene, all_objects, current_context
from ..core import ControlArrays
from ..errors import JobError
from ..memory import FAIRING_PG_surface, source_of
from ..mesh import scans
from ..mesh.object import Reference, changed_keys, session_key
from ..mesh.read import control_mesh, group_values, read_mesh, shown_selection
from ..mesh.shape_keys import ShapeKeys, read_shape_keys
from ..mesh.world_shape import matrix_relative_to, world_matrix, world_shape
from ..redraw import tag_sidebars
from ..settings import NAMES, AnySettings, is_evaluated
from . import curve_cage, neighbours, place

SOURCE_CHANGED = "Source changed"
SETTINGS_CHANGED = "Settings changed"
SOURCE_MOVED = "Source moved"
SCAN_CHANGED = "Scan changed"
SCAN_MOVED = "Scan moved"
NEIGHBOUR_CHANGED = "Neighbour changed"
NEIGHBOUR_MOVED = "Neighbour moved"
UNFINISHED = "Shown with fewer levels"
# settings that do not change an existing surface
_ELSEWHERE = {"hide_source", "copy_modifiers"}
_SOON = 0.3  # seconds

_surfaces: dict[int, Reference] = {}  # known surfaces
# surface: its state when last read, as far as another object can change it
_seen: dict[int, dict[str, Any]] = {}
_unread: set[int] = set()  # surfaces whose sources may have changed since
_watched: dict[int, set[int]] = {}  # source or its mesh: surfaces made from it


@dataclass(frozen=True)
class OwnMesh:
    """The data of a source's own mesh, without modifiers, that affect a surface."""

    arrays: ControlArrays
    selection: np.ndarray | None  # (m,) bool, if the settings use the selection
    values: dict[str, np.ndarray]  # of groups, without missing ones
    keys: ShapeKeys | None  # if the settings use shape keys

    @classmethod
    def read(cls, context: Context, source: Object, settings: AnySettings) -> "OwnMesh":
        values: dict[str, np.ndarray] = {}
        with control_mesh(context, source) as mesh:
            arrays = read_mesh(mesh)
            selection = shown_selection(mesh.polygons) if settings.use_selection else None
            with suppress(JobError):
                values = group_values(source, mesh, settings)
        keys = read_shape_keys(source, len(arrays.positions)) if settings.use_shape_keys else None
        return cls(arrays, selection, values, keys)

    @property
    def parts(self) -> list[np.ndarray | None]:
        arrays = [getattr(self.arrays, field.name) for field in fields(self.arrays)]
        keys = None if self.keys is None else self.keys.shapes
        return [*arrays, self.selection, *self.values.values(), keys]


def made_of(
    context: Context, source: Object, settings: AnySettings, read: OwnMesh | None
) -> dict[str, Any]:
    """The present state of everything a surface depends on, for `note`. `read`: None: read it now."""
    total = _checksum(context, source, settings, read)
    return {"settings": _that_count(settings), "source": total}


def beside_of(
    context: Context, neighbour: Object, surface: Object, halfway: bool
) -> dict[str, Any]:
    """The state of the neighbour that is met; half way that of its source, settings and place."""
    source = source_of(neighbour) if halfway else None
    if source is None:
        return scans.made_of(context, [neighbour], surface)
    settings = neighbour.discrete_fairing
    total = _checksum(context, source, settings)
    return {
        "shape": zlib.crc32(repr(_that_count(settings)).encode(), total),
        "places": [matrix_relative_to(surface, world_matrix(neighbour)).tolist()],
    }


def note(target: Object, made: dict[str, Any]) -> None:
    """Stores the state that `target` was made from."""
    memory.keep(target, "made", made)
    _unread.add(session_key(target))
    know(target)


def know(target: Object) -> None:
    """Starts tracking changes of the source of `target`."""
    key, source = session_key(target), source_of(target)
    _surfaces.setdefault(key, Reference(target))
    if source is not None:
        beside = (*curve_cage.watched(source), *scans.watched(neighbours.with_scans(target)))
        met = neighbours.neighbour_of(target)
        for block in (source, source.data, source.data.shape_keys, *beside, met):
            if block is not None:
                _watched.setdefault(session_key(block), set()).add(key)


def known_surfaces() -> Iterator[Object]:
    for reference in list(_surfaces.values()):
        target = reference.find()
        if target is not None and target.users_scene and is_own(target):
            yield target


def why_stale(target: Object) -> str:
    """Why `target` is out of date, in a few words; empty if it is not, or if that is unknown."""
    made = memory.recall(target, "made")
    if not made or source_of(target) is None:
        return ""
    know(target)
    if target.discrete_fairing.unfinished:
        return UNFINISHED
    neighbour = neighbours.neighbour_of(target)
    met = made.get("neighbour", "")
    if _differ(made["settings"], target.discrete_fairing) or met != getattr(neighbour, "name", ""):
        return SETTINGS_CHANGED
    key = session_key(target)
    if key not in _seen or key in _unread:
        _unread.add(key)
        if bpy.app.background:
            _look()
        else:
            events.start_timer(_look, _SOON)
    now = _seen.get(key, made)
    if now["source"] != made["source"]:
        return SOURCE_CHANGED
    if place.moved(target):
        return SOURCE_MOVED
    if neighbour is not None and neighbours.is_mutual(target):
        its = memory.recall(neighbour, "made")
        if its and _differ(its["settings"], neighbour.discrete_fairing):
            return NEIGHBOUR_CHANGED
    for kind, changed, moved in (
        ("scans", SCAN_CHANGED, SCAN_MOVED),
        ("beside", NEIGHBOUR_CHANGED, NEIGHBOUR_MOVED),
    ):
        if kind in made and kind in now:
            one, other = made[kind], now[kind]
            if (one["shape"], len(one["places"])) != (other["shape"], len(other["places"])):
                return changed
            if scans.are_moved(one, other):
                return moved
    return ""


def stale_surfaces(source: Object | None = None) -> Iterator[Object]:
    """The known surfaces in the file that are out of date; with `source`, only those made from it."""
    for target in known_surfaces():
        if (source is None or target.discrete_fairing.source == source) and why_stale(target):
            yield target


def is_own(target: Object) -> bool:
    """Whether its mesh can be recomputed: not for linked data and overrides."""
    return not (target.library or target.data.library)


def _that_count(settings: AnySettings) -> dict[str, Any]:
    return {name: getattr(settings, name) for name in NAMES if name not in _ELSEWHERE}


def _differ(made: dict[str, Any], settings: FAIRING_PG_surface) -> bool:
    """Whether a surface was `made` with other settings; settings added since then count as unset."""
    properties: Any = settings.bl_rna.properties
    return any(
        now != made.get(name, properties[name].default)
        for name, now in _that_count(settings).items()
    )


def _look() -> None:
    """Reads the sources that may have changed."""
    context = current_context()
    for key in list(_unread):
        target = _surfaces[key].find() if key in _surfaces else None
        source = source_of(target) if target is not None else None
        if target is not None and source is not None:
            now: dict[str, Any] = {"source": _checksum(context, source, target.discrete_fairing)}
            if len(target.discrete_fairing_fit.scans):
                now["scans"] = scans.made_of(context, memory.scans_of(target), source)
            met, halfway = neighbours.neighbour_of(target), neighbours.is_mutual(target)
            if met is not None:
                now["beside"] = beside_of(context, met, target, halfway)
            _seen[key] = now
    _unread.clear()
    tag_sidebars(context)


def _checksum(
    context: Context, source: Object, settings: AnySettings, read: OwnMesh | None = None
) -> int:
    """A checksum of all data of the source that affect a surface."""
    parts = (read or OwnMesh.read(context, source, settings)).parts
    words: list[Any] = [world_shape(source).rows]
    if curve_cage.is_cage(source):
        pieces, options = curve_cage.made_of(source)
        parts += pieces
        words.append(options)
    if is_evaluated(settings):
        words += [_values(modifier) for modifier in source.modifiers]
    total = zlib.crc32(repr(words).encode())
    for part in parts:
        total = zlib.crc32(b"" if part is None else np.ascontiguousarray(part).tobytes(), total)
    return total


def _values(modifier: Any) -> list[Any]:
    plain = (bool, int, float, str)
    found = [getattr(modifier, p.identifier) for p in modifier.bl_rna.properties]
    return [value for value in found if isinstance(value, plain)]


def _note_changes(_scene: Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if not _watched:
        return
    for key in changed_keys(depsgraph, moved=True):
        _unread.update(_watched.get(key, ()))


def _mark_all_unread(*_: Any) -> None:
    """Marks all surfaces for reading: undo may have changed anything."""
    _unread.update(_surfaces)


def _forget() -> None:
    for known in (_surfaces, _seen, _unread, _watched):
        known.clear()


def _begin(*_: Any) -> None:
    """Starts with the surfaces of the file that was just opened."""
    _forget()
    for target in all_objects():
        if target.type == "MESH" and target.discrete_fairing.source is not None:
            know(target)


HANDLERS = {
    "depsgraph_update_post": _note_changes,
    "undo_post": _mark_all_unread,
    "redo_post": _mark_all_unread,
    "load_post": _begin,
}
TIMERS = (_look,)


def unregister() -> None:
    _forget()
