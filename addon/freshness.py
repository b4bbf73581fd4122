# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a surface is still that of its source and settings: what it was made of is kept with it.

Panels only look it up. After a change a timer reads the source again; without a window that is
done when somebody asks. What is only carried, such as UV maps, does not count.
"""

import zlib
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, fields
from typing import Any

import bpy
import numpy as np

from . import curve_cage, events, memory, neighbours, place
from .blender import Context, Object, Scene, all_objects, current_context
from .core import ControlArrays
from .errors import JobError
from .memory import FAIRING_PG_surface, source_of
from .mesh import scans
from .mesh.object import Reference, changed_keys, session_key
from .mesh.read import (
    control_mesh,
    read_mesh,
    shown_selection,
    tolerance_factors,
    vertex_pulls,
)
from .mesh.shape_keys import ShapeKeys, read_shape_keys
from .mesh.world_shape import world_shape
from .redraw import tag_outliners, tag_sidebars
from .settings import NAMES, AnySettings, is_evaluated

SOURCE_CHANGED = "Source changed"
SETTINGS_CHANGED = "Settings changed"
SOURCE_MOVED = "Source moved"
SCAN_CHANGED = "Scan changed"
SCAN_MOVED = "Scan moved"
NEIGHBOUR_CHANGED = "Neighbour changed"
NEIGHBOUR_MOVED = "Neighbour moved"
UNFINISHED = "Shown with fewer levels"
# settings that change nothing about a surface that is there
_ELSEWHERE = {"hide_source", "copy_modifiers", "memory_limit"}
_SOON = 0.3  # seconds

_surfaces: dict[int | str, Reference] = {}  # those that are known
# surface: checksum of its source, and what its scans and its neighbour are, as of the last look
_seen: dict[int | str, tuple[int, dict[str, Any] | None, dict[str, Any] | None]] = {}
_unread: set[int | str] = set()  # surfaces whose source may have changed since
_watched: dict[int | str, set[int | str]] = {}  # source or its mesh: surfaces


@dataclass(frozen=True)
class OwnMesh:
    """What of a source's own mesh, as modelled, goes into a surface."""

    arrays: ControlArrays
    selection: np.ndarray | None  # (m,) bool, where the settings ask for it
    values: tuple[np.ndarray | None, ...]  # those of groups; without those that are not there
    keys: ShapeKeys | None  # where the settings ask for them

    @classmethod
    def read(cls, context: Context, source: Object, settings: AnySettings) -> "OwnMesh":
        values: list[np.ndarray | None] = []
        with control_mesh(context, source) as mesh:
            arrays = read_mesh(mesh)
            selection = shown_selection(mesh.polygons) if settings.use_selection else None
            with suppress(JobError):
                values.append(tolerance_factors(source, mesh, settings))
                values.append(vertex_pulls(source, mesh, settings))
        keys = read_shape_keys(source, len(arrays.positions)) if settings.use_shape_keys else None
        return cls(arrays, selection, tuple(values), keys)

    @property
    def parts(self) -> list[np.ndarray | None]:
        arrays = [getattr(self.arrays, field.name) for field in fields(self.arrays)]
        keys = None if self.keys is None else self.keys.shapes
        return [*arrays, self.selection, *self.values, keys]


def made_of(
    context: Context, source: Object, settings: AnySettings, read: OwnMesh | None
) -> dict[str, Any]:
    """What a surface is made of at this moment, to be kept with it by `note`. `read`: None: to be read."""
    total = _checksum(context, source, settings, read)
    return {"settings": _that_count(settings), "source": total}


def note(target: Object, made: dict[str, Any]) -> None:
    """Keeps with `target` what it was made of."""
    memory.keep(target, "made", made)
    _unread.add(session_key(target))
    know(target)


def know(target: Object) -> None:
    """From now on changes of its source are heard of."""
    key, source = session_key(target), source_of(target)
    _surfaces.setdefault(key, Reference(target))
    if source is not None:
        beside = (*curve_cage.watched(source), *scans.watched(neighbours.with_scans(target)))
        for block in (source, source.data, source.data.shape_keys, *beside):
            if block is not None:
                _watched.setdefault(session_key(block), set()).add(key)


def known_surfaces() -> Iterator[Object]:
    """Those that are there."""
    for reference in list(_surfaces.values()):
        target = reference.find()
        if target is not None and target.users_scene and is_own(target):
            yield target


def why_stale(target: Object) -> str:
    """Why `target` is out of date, in a few words; empty if it is not, or nobody can tell."""
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
    total, near, beside = _seen.get(key, (made["source"], None, None))
    if total != made["source"]:
        return SOURCE_CHANGED
    if place.moved(target):
        return SOURCE_MOVED
    return _why_off(made.get("scans"), near, SCAN_CHANGED, SCAN_MOVED) or _why_off(
        made.get("beside"), beside, NEIGHBOUR_CHANGED, NEIGHBOUR_MOVED
    )


def _why_off(
    made: dict[str, Any] | None, now: dict[str, Any] | None, changed: str, moved: str
) -> str:
    """Other objects, of before and of now."""
    if not made or now is None:
        return ""
    if (made["shape"], len(made["places"])) != (now["shape"], len(now["places"])):
        return changed
    return moved if scans.are_moved(made, now) else ""


def stale_surfaces(source: Object | None = None) -> Iterator[Object]:
    """The known surfaces in the file that are out of date; those made from `source` alone."""
    for target in known_surfaces():
        if (source is None or target.discrete_fairing.source == source) and why_stale(target):
            yield target


def is_own(target: Object) -> bool:
    """Whether its mesh can be made again: not of linked data, which overrides have too."""
    return not (target.library or target.data.library)


def _that_count(settings: AnySettings) -> dict[str, Any]:
    return {name: getattr(settings, name) for name in NAMES if name not in _ELSEWHERE}


def _differ(made: dict[str, Any], settings: FAIRING_PG_surface) -> bool:
    """Of what a surface was `made` with: a setting that it does not know, as it is newer than the
    surface, counts as one that nobody has chosen.
    """
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
            total, near = _checksum(context, source, target.discrete_fairing), None
            if len(target.discrete_fairing_fit.scans):
                near = scans.made_of(context, memory.scans_of(target), source)
            met = neighbours.watched(target)
            beside = None if met is None else scans.made_of(context, [met], target)
            _seen[key] = total, near, beside
    _unread.clear()
    tag_sidebars(context)
    tag_outliners(context)


def _checksum(
    context: Context, source: Object, settings: AnySettings, read: OwnMesh | None = None
) -> int:
    """Of all of the source that goes into a surface."""
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
    """What the modifier's properties are, as far as they are plain."""
    plain = (bool, int, float, str)
    found = [getattr(modifier, p.identifier) for p in modifier.bl_rna.properties]
    return [value for value in found if isinstance(value, plain)]


def _note_changes(_scene: Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if not _watched:
        return
    for key in changed_keys(depsgraph, moved=True):
        _unread.update(_watched.get(key, ()))


def _mark_all_unread(*_: Any) -> None:
    """After undo anything may have changed."""
    _unread.update(_surfaces)


def _begin(*_: Any) -> None:
    """With the surfaces of the file that was just opened."""
    for known in (_surfaces, _seen, _unread, _watched):
        known.clear()
    for target in all_objects():
        if target.type == "MESH" and target.discrete_fairing.source is not None:
            know(target)


_HANDLERS = {
    "depsgraph_update_post": _note_changes,
    "undo_post": _mark_all_unread,
    "redo_post": _mark_all_unread,
    "load_post": _begin,
}


def register() -> None:
    events.listen(_HANDLERS)


def unregister() -> None:
    events.ignore(_HANDLERS)
    events.stop_timer(_look)
    for known in (_surfaces, _seen, _unread, _watched):
        known.clear()
