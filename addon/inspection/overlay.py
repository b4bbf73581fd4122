# SPDX-License-Identifier: GPL-3.0-or-later
"""Section curves and their combs, drawn over the viewport.

The drawing depends on the object's settings only. Points on the graphics card are a cache: any change
of a mesh, undo or a new file clears it, and the next drawing fills it.
"""

from dataclasses import dataclass, field
from typing import Any

import bpy
import gpu as _gpu
import numpy as np
from gpu_extras import batch as _batch
from mathutils import Matrix

from ..blender import Object, current_context, viewport_of
from ..mesh.object import Showing, changed_keys, session_key
from ..redraw import tag_viewports
from .overlay_arrays import lines_of, pulled, surface_of
from .sections import Drawn

gpu: Any = _gpu  # its stubs are incomplete
batch_for_shader: Any = _batch.batch_for_shader


@dataclass
class _Entry:
    """The data of one object on the graphics card."""

    surface: Drawn
    smooth: bool
    lines: dict[tuple[Any, ...], list[tuple[Any, tuple[float, ...]]]] = field(default_factory=dict)


_entries: dict[int, _Entry] = {}
_shown = Showing(lambda target: bool(target.discrete_fairing_inspection.sections))
_handle: Any = None


def is_on() -> bool:
    """Whether drawing is possible: in a window."""
    return _handle is not None


def shown_changed() -> None:
    """Call this when an object's displayed values change."""
    _shown.forget()
    redraw()


def moved(target: Object) -> None:
    """Call this when a handler has written its mesh, which Blender does not report to handlers."""
    _entries.pop(session_key(target), None)


def redraw() -> None:
    """Redraws all viewports after settings have changed."""
    tag_viewports(current_context())


def _draw() -> None:
    context = current_context()
    viewport = viewport_of(context)
    if viewport is None:
        return
    space, view = viewport
    for target in _shown:
        if target.mode in {"OBJECT", "EDIT"} and target.visible_in_viewport_get(space):
            _draw_object(context, target, view)


def _draw_object(context: Any, target: Object, view: Any) -> None:
    settings = context.scene.discrete_fairing_inspection
    key = session_key(target)
    entry = _entries.get(key)
    if entry is None or entry.smooth != settings.smooth:
        surface = surface_of(target, context.evaluated_depsgraph_get(), settings.smooth)
        entry = _entries[key] = _Entry(surface, settings.smooth)
    if not len(entry.surface.triangles):
        return
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.blend_set("ALPHA")
    try:
        projection = pulled(np.array(view.window_matrix), view.view_distance)
        _draw_lines(entry, target, settings, projection)
    finally:
        gpu.state.depth_test_set("NONE")
        gpu.state.blend_set("NONE")


def _draw_lines(entry: _Entry, target: Object, settings: Any, projection: np.ndarray) -> None:
    key = (
        tuple(sorted(settings.section_axes)),
        settings.section_count,
        settings.show_combs,
        settings.comb_scale,
    )
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    if key not in entry.lines:
        entry.lines = {
            key: [
                (batch_for_shader(shader, "LINES", {"pos": points}), colour)
                for points, colour in lines_of(entry.surface, settings)
            ]
        }
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", 1.5)
    with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        gpu.matrix.load_projection_matrix(Matrix(projection.tolist()))
        gpu.matrix.multiply_matrix(target.matrix_world)
        for batch, colour in entry.lines[key]:
            shader.uniform_float("color", colour)
            batch.draw(shader)


def _note_changes(_scene: Any, depsgraph: bpy.types.Depsgraph) -> None:
    """Drops entries that changes make invalid, including modifiers that read another object."""
    if not _entries:
        return
    changed = changed_keys(depsgraph, moved=False)
    for reference in _shown.references or ():
        target = reference.find()
        if target is None or changed & {session_key(target), session_key(target.data)}:
            _entries.pop(reference.key, None)


def _forget(*_: Any) -> None:
    _shown.forget()
    _entries.clear()


HANDLERS = {
    "depsgraph_update_post": _note_changes,
    "frame_change_post": _forget,
    "undo_post": _forget,
    "redo_post": _forget,
    "load_pre": _forget,
    "load_post": _forget,
}


def register() -> None:
    global _handle
    if bpy.app.background:
        return
    _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW")


def unregister() -> None:
    global _handle
    if bpy.app.background:
        return
    bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
    _handle = None
    _forget()
