# SPDX-License-Identifier: GPL-3.0-or-later
"""Tracks whether measurements still apply to a mesh; drawing only looks up the result."""

import zlib
from collections.abc import Callable, Hashable, Sequence
from typing import Any, cast

import bpy
import numpy as np

from .. import events, size
from ..blender import Context, Mesh, Scene, column, current_context
from ..redraw import INTERVAL, tag_sidebars
from .object import session_key

_watched: dict[int, int | None] = {}  # mesh key: checksum of its positions when it was measured
_triangles: dict[int, tuple[tuple[int, int], int]] = {}  # mesh key: its size, and triangles
_changed: set[int] = set()  # keys of meshes that have changed since
_seen: dict[int, dict[Hashable, Any]] = {}  # mesh key: the values that panels show, by name
_unseen: dict[tuple[int, Hashable], Callable[[Mesh], Any]] = {}  # values still to be measured

# edges; values of larger meshes are measured once changes pause
MEASURED_WHILE_DRAWING = 10_000


def watch(context: Context, mesh: Mesh) -> list[int]:
    """Notes that a measurement of `mesh` applies from now on; returns its element counts."""
    context.view_layer.update()  # so that our own changes are not reported later
    _watched[session_key(mesh)] = None if mesh.is_editmode else _checksum(mesh)
    _changed.discard(session_key(mesh))
    return counts(mesh)


def coarse_triangles(mesh: Mesh) -> int:
    """Triangles equivalent to `mesh`, for drawing; in Edit Mode as at the last update."""
    now = (len(mesh.loops), len(mesh.polygons))
    known = _triangles.get(session_key(mesh))
    if known is None or known[0] != now:
        count = size.coarse_triangles(column(mesh.polygons, "loop_total", np.int32))
        known = _triangles[session_key(mesh)] = (now, count)
    return known[1]


def shown(mesh: Mesh, name: Hashable, measure: Callable[[Mesh], Any], nothing: Any) -> Any:
    """`measure(mesh)` at the last change, `nothing` until a large mesh is measured in a window."""
    key = session_key(mesh)
    known = _seen.setdefault(key, {})
    if bpy.app.background:
        return measure(mesh)
    if name not in known:
        if len(mesh.edges) > MEASURED_WHILE_DRAWING:
            _unseen[key, name] = measure
            events.start_timer(measure_unseen, INTERVAL)
            return nothing
        known[name] = measure(mesh)
    return known[name]


def measure_unseen() -> None:
    """Measures the values that panels have requested."""
    meshes = {session_key(mesh): mesh for mesh in bpy.data.meshes}
    for (key, name), measure in list(_unseen.items()):
        if key in meshes:
            _seen.setdefault(key, {})[name] = measure(cast(Mesh, meshes[key]))
    _unseen.clear()
    tag_sidebars(current_context())


def counts(mesh: Mesh) -> list[int]:
    """Numbers of vertices, edges, faces; in Edit Mode at the last update."""
    return [len(mesh.vertices), len(mesh.edges), len(mesh.polygons)]


def is_stale(mesh: Mesh, counts_then: Sequence[int]) -> bool:
    """Whether `mesh` has changed since `watch`; after loading a file only counts are compared."""
    return session_key(mesh) in _changed or (
        not mesh.is_editmode and counts(mesh) != list(counts_then)
    )


def _note_changes(_scene: Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if not (_watched or _seen):
        return
    for update in depsgraph.updates:
        if not isinstance(update.id, Mesh) or not update.is_updated_geometry:
            continue
        mesh = cast(Mesh, update.id.original)
        key = session_key(mesh)
        _seen.pop(key, None)
        if key not in _watched:
            continue
        # new attributes and leaving Edit Mode do not change the shape
        if mesh.is_editmode or (_watched[key] is not None and _watched[key] != _checksum(mesh)):
            _changed.add(key)
        elif _watched[key] is not None:
            _changed.discard(key)  # the change was undone


def _forget(*_: Any) -> None:
    _watched.clear()
    _triangles.clear()
    _changed.clear()
    _look_again()


def _look_again(*_: Any) -> None:
    """Undo may have changed any mesh."""
    _seen.clear()
    _unseen.clear()


def _checksum(mesh: Mesh) -> int:
    corners = column(mesh.loops, "vertex_index", np.int32)
    return zlib.crc32(corners.tobytes(), zlib.crc32(column(mesh.vertices, "co", width=3).tobytes()))


HANDLERS = {
    "depsgraph_update_post": _note_changes,
    "undo_post": _look_again,
    "redo_post": _look_again,
    "load_post": _forget,
}
TIMERS = (measure_unseen,)


def unregister() -> None:
    _forget()
