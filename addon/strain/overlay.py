# SPDX-License-Identifier: GPL-3.0-or-later
"""Dots, needles and labels over the viewport, at the vertices of sources whose strain is shown.

Hidden ones are drawn faintly. Points on the graphics card are a cache.
"""

from dataclasses import dataclass
from typing import Any, cast

import blf
import bpy
import gpu as _gpu
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from gpu_extras import batch as _batch
from mathutils import Matrix, Vector

from ..blender import Context, Object, current_context, viewport_of
from ..inspection.overlay_arrays import pulled
from ..live.switch import surfaces_of
from ..mesh.object import session_key
from ..mesh.world_shape import world_matrix
from ..units import Units
from . import cache
from .drawn import dots, labels, magnification, needles
from .strained import Strained

gpu: Any = _gpu  # its stubs are incomplete
batch_for_shader: Any = _batch.batch_for_shader

_RADIUS = 5.0  # pixels, of a dot
_LINE = 2.5  # pixels, of a needle
_TEXT = 12.0  # points
_BEHIND = 0.25  # opacity of dots behind the surface
_INWARDS = 0.65  # opacity of needles behind it: all inward ones are, perhaps with the worst
_FAINT = 0.4  # opacity during an update, and of labels of vertices that are not outliers
_AWAY = 8  # pixels from a needle to its label

_VERTEX = """
void main() {
  vec4 seen = transform * vec4(place, 1.0);
  gl_Position = seen + vec4(away * radius * seen.w, 0.0, 0.0);
  from_centre = away;
  tint = colour;
}
"""
_FRAGMENT = """
void main() {
  float far = length(from_centre);
  if (far > 1.0) {
    discard;
  }
  vec3 rim = vec3(0.02);
  fragment = vec4(mix(tint.rgb, rim, smoothstep(0.65, 0.8, far)), tint.a * opacity);
}
"""


@dataclass
class _Entry:
    """The data of one source on the graphics card."""

    strained: Strained
    dots: Any
    times: float | None = None
    needles: Any = None


_entries: dict[int, _Entry] = {}
_shader: Any = None
_handles: list[Any] = []


def is_on() -> bool:
    """Whether drawing is possible: in a window."""
    return bool(_handles)


def _seen(space: Any) -> list[tuple[Object, Strained]]:
    """Sources to draw in this viewport: they or surfaces made from them are visible."""
    return [
        (source, strained)
        for source in cache.shown_sources
        if source.mode in {"OBJECT", "EDIT"}
        and (strained := cache.found_of(source)) is not None
        and any(o.visible_in_viewport_get(space) for o in (source, *surfaces_of(source)))
    ]


def _viewport(context: Context) -> tuple[Any, Any] | None:
    """The space and the view being drawn; None if overlays are off."""
    found = viewport_of(context)
    return found if found and found[0].overlay.show_overlays else None


def _draw_points() -> None:
    context = current_context()
    viewport = _viewport(context)
    if viewport is None:
        return
    space, view = viewport
    length = context.scene.discrete_fairing_strain.needle_length
    for source, strained in _seen(space):
        if len(strained.held):
            _draw_source(source, strained, length, view)


def _draw_source(source: Object, strained: Strained, length: float, view: Any) -> None:
    key, times = session_key(source), magnification(strained, length)
    entry = _entries.get(key)
    if entry is None or entry.strained is not strained:
        entry = _entries[key] = _Entry(strained, _dot_batch(strained))
    if entry.times != times:
        entry.times, entry.needles = times, _needle_batch(strained, times)
    projection = np.array(view.window_matrix)
    for _ in range(2):  # once more over section curves, one of which is offset towards the eye
        projection = pulled(projection, view.view_distance)
    opacity = _FAINT if cache.is_behind(source) else 1.0
    gpu.state.blend_set("ALPHA")
    try:
        for test, share in (("NONE", _BEHIND), ("LESS_EQUAL", 1.0)):
            gpu.state.depth_test_set(test)
            _draw_needles(entry, source, projection, opacity * share)
            _draw_dots(entry, source, projection, view, opacity * share)
    finally:
        gpu.state.depth_test_set("NONE")
        gpu.state.blend_set("NONE")


def _draw_dots(
    entry: _Entry, source: Object, projection: np.ndarray, view: Any, opacity: float
) -> None:
    transform = projection @ np.array(view.view_matrix) @ np.array(world_matrix(source))
    width, height = gpu.state.viewport_get()[2:]
    radius = 2.0 * _RADIUS * _scale()
    _shader.bind()
    _shader.uniform_float("transform", Matrix(transform.tolist()))
    _shader.uniform_float("radius", (radius / width, radius / height))
    _shader.uniform_float("opacity", opacity)
    entry.dots.draw(_shader)


def _draw_needles(entry: _Entry, source: Object, projection: np.ndarray, opacity: float) -> None:
    shader = gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", _LINE * _scale())
    with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        gpu.matrix.load_projection_matrix(Matrix(projection.tolist()))
        gpu.matrix.multiply_matrix(world_matrix(source))
        if opacity >= 1.0:
            entry.needles[0].draw(shader)
        else:
            entry.needles[1].draw(shader)


def _scale() -> float:
    return current_context().preferences.system.ui_scale


def _dot_batch(strained: Strained) -> Any:
    places, away, colours = dots(strained)
    return batch_for_shader(_shader, "TRIS", {"place": places, "away": away, "colour": colours})


def _needle_batch(strained: Strained, times: float) -> tuple[Any, Any]:
    """Solid and pale: the shader takes its opacity from the colours."""
    shader = gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")
    points, solid = needles(strained, times)
    pale = solid * np.array((1.0, 1.0, 1.0, _INWARDS), np.float32)
    solid_batch, pale_batch = (
        batch_for_shader(shader, "LINES", {"pos": points, "color": colours})
        for colours in (solid, pale)
    )
    return solid_batch, pale_batch


def _draw_labels() -> None:
    context = current_context()
    viewport = _viewport(context)
    if viewport is None:
        return
    space, view = viewport
    drawing, region = context.scene.discrete_fairing_strain, context.region
    blf.size(0, _TEXT * _scale())
    for source, strained in _seen(space):
        matrix = world_matrix(source)
        times = magnification(strained, drawing.needle_length)

        text = Units.of(context.scene).lengths(strained.largest)
        for place, label, is_wrong in labels(strained, drawing.label_count, times, text):
            at = location_3d_to_region_2d(cast(Any, region), view, matrix @ Vector(place.tolist()))
            if at is not None:
                _draw_label(label, at.x + _AWAY, at.y + _AWAY, 1.0 if is_wrong else _FAINT)


def _draw_label(label: str, x: float, y: float, opacity: float) -> None:
    """White with a dark outline, since stripes behind it are white too."""
    outline = ((-1, 0), (1, 0), (0, -1), (0, 1))
    for right, up, grey in (*((*way, 0.0) for way in outline), (0, 0, 1.0)):
        blf.color(0, grey, grey, grey, opacity)
        blf.position(0, x + right * _scale(), y + up * _scale(), 0)
        blf.draw(0, label)


def _make_shader() -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.push_constant("MAT4", "transform")
    info.push_constant("VEC2", "radius")
    info.push_constant("FLOAT", "opacity")
    info.vertex_in(0, "VEC3", "place")
    info.vertex_in(1, "VEC2", "away")
    info.vertex_in(2, "VEC4", "colour")
    between = gpu.types.GPUStageInterfaceInfo("fairing_dots")
    between.smooth("VEC2", "from_centre")
    between.flat("VEC4", "tint")
    info.vertex_out(between)
    info.fragment_out(0, "VEC4", "fragment")
    info.vertex_source(_VERTEX)
    info.fragment_source(_FRAGMENT)
    return gpu.shader.create_from_info(info)


def _forget(*_: Any) -> None:
    _entries.clear()


def _start() -> None:
    """From a timer, since there is no graphics card while Blender starts."""
    global _shader
    _shader = _make_shader()
    add = bpy.types.SpaceView3D.draw_handler_add
    _handles.append(add(_draw_points, (), "WINDOW", "POST_VIEW"))
    _handles.append(add(_draw_labels, (), "WINDOW", "POST_PIXEL"))


HANDLERS = {"load_pre": _forget}
TIMERS = (_start,)


def register() -> None:
    if bpy.app.background:
        return
    # persistent, since opening a file ends other timers
    bpy.app.timers.register(_start, first_interval=0.0, persistent=True)


def unregister() -> None:
    global _shader
    if bpy.app.background:
        return
    for handle in _handles:
        bpy.types.SpaceView3D.draw_handler_remove(handle, "WINDOW")
    _handles.clear()
    _shader = None
    _forget()
