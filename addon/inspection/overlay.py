# SPDX-License-Identifier: GPL-3.0-or-later
"""Stripes in Solid and Wireframe and in Edit Mode, and section curves: drawn over the viewport.

What is drawn hangs on the object's settings alone. Points on the graphics card are a cache: every
change of a mesh, undo and a new file throw it away, and the next drawing makes it anew.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, cast

import bpy
import gpu as _gpu
import numpy as np
from gpu_extras import batch as _batch
from mathutils import Matrix

from .. import events
from ..blender import Object, all_objects, current_context
from ..mesh.object import Reference, changed_keys, session_key
from .drawn import Drawn
from .overlay_arrays import lines_of, pulled, surface_of, uniforms
from .stripes import STRIPES

gpu: Any = _gpu  # whose stubs say little of it
batch_for_shader: Any = _batch.batch_for_shader

# viewports whose shading shows no material
SHADINGS = {"SOLID", "WIREFRAME"}

_THROUGH = 0.75  # in Edit Mode: vertices and edges are to be seen through dark stripes

_STRUCT = """
struct Look {
  mat4 model_view;
  mat4 projection;
  mat4 normals;
  mat4 room;
  vec4 axis;   /* w: 1 for the mirrored ray, 0 for the normal */
  vec4 wave;   /* waves, level, width; w: 1 in perspective */
  vec4 dark;
  vec4 light;  /* w: opacity */
};
"""
_VERTEX = """
void main() {
  vec4 seen = look.model_view * vec4(position, 1.0);
  at = seen.xyz;
  turned = mat3(look.normals) * normal;
  gl_Position = look.projection * seen;
}
"""
_FRAGMENT = """
void main() {
  vec3 ray = look.wave.w > 0.5 ? normalize(at) : vec3(0.0, 0.0, -1.0);
  vec3 n = normalize(turned);
  n = dot(n, ray) > 0.0 ? -n : n;
  vec3 along = normalize(mat3(look.room) * (look.axis.w > 0.5 ? reflect(ray, n) : n));
  float phase = look.wave.x * asin(clamp(dot(along, look.axis.xyz), -1.0, 1.0));
  float blur = max(look.wave.z, 0.7 * fwidth(phase));
  float tone = smoothstep(look.wave.y - blur, look.wave.y + blur, sin(phase));
  colour = vec4(mix(look.dark.rgb, look.light.rgb, tone), look.light.w);
}
"""


@dataclass
class _Entry:
    """What the graphics card keeps of one object."""

    surface: Drawn
    smooth: bool
    stripes: Any = None
    uniforms: Any = None
    lines: dict[tuple[Any, ...], list[tuple[Any, tuple[float, ...]]]] = field(default_factory=dict)


_entries: dict[int | str, _Entry] = {}
_shown: list[Reference] | None = None  # objects with something to draw; None: to be looked for
_count = 0  # of the file's objects, when they were looked through
_shader: Any = None
_handle: Any = None


def is_on() -> bool:
    """Whether anything is ever drawn: in a window, by a graphics card that takes the shader."""
    return _handle is not None


def shown_changed() -> None:
    """To be called when an object has been told to show something else."""
    global _shown
    _shown = None
    redraw()


def moved(target: Object) -> None:
    """To be called when a handler has written its mesh: Blender tells no handler of that."""
    _entries.pop(session_key(target), None)


def redraw() -> None:
    """All viewports, after settings have changed."""
    for window in current_context().window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def _objects() -> Iterable[Object]:
    global _shown, _count
    count = len(bpy.data.objects)
    if _shown is None or count != _count:
        _count = count
        _shown = [Reference(o) for o in all_objects() if o.type == "MESH" and _shows_anything(o)]
    return [found for reference in _shown if (found := reference.find()) is not None]


def _shows_anything(target: Object) -> bool:
    shown = target.discrete_fairing_inspection
    return shown.mode in STRIPES or shown.sections


def _draw() -> None:
    context = current_context()
    space, view = cast(Any, context.space_data), cast(Any, context.region_data)
    if space is None or space.type != "VIEW_3D" or view is None:
        return
    for target in _objects():
        if target.mode in {"OBJECT", "EDIT"} and target.visible_in_viewport_get(space):
            _draw_object(context, target, space, view)


def _draw_object(context: Any, target: Object, space: Any, view: Any) -> None:
    shown, settings = target.discrete_fairing_inspection, context.scene.discrete_fairing_inspection
    striped = shown.mode in STRIPES and space.shading.type in SHADINGS
    if not striped and not shown.sections:
        return
    key = session_key(target)
    entry = _entries.get(key)
    if entry is None or entry.smooth != settings.smooth:
        surface = surface_of(target, context.evaluated_depsgraph_get(), settings.smooth)
        entry = _entries[key] = _Entry(surface, settings.smooth)
    if not len(entry.surface.triangles):
        return
    projection = pulled(np.array(view.window_matrix), view.view_distance)
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.blend_set("ALPHA")
    try:
        if striped:
            gpu.state.depth_mask_set(True)
            _draw_stripes(entry, target, settings, np.array(view.view_matrix), projection)
        if shown.sections:
            _draw_lines(entry, target, settings, pulled(projection, view.view_distance))
    finally:
        gpu.state.depth_mask_set(False)
        gpu.state.depth_test_set("NONE")
        gpu.state.blend_set("NONE")


def _draw_stripes(
    entry: _Entry, target: Object, settings: Any, view: np.ndarray, projection: np.ndarray
) -> None:
    values = uniforms(
        target.discrete_fairing_inspection.mode,
        settings,
        np.array(target.matrix_world),
        view,
        projection,
    )
    values[-1] = _THROUGH if target.mode == "EDIT" else 1.0
    data = gpu.types.Buffer("FLOAT", len(values), values)
    if entry.stripes is None:
        surface = entry.surface
        entry.stripes = batch_for_shader(
            _shader,
            "TRIS",
            {"position": surface.points, "normal": surface.normals},
            indices=surface.triangles,
        )
        entry.uniforms = gpu.types.GPUUniformBuf(data)
    else:
        entry.uniforms.update(data)
    _shader.bind()
    _shader.uniform_block("look", entry.uniforms)
    entry.stripes.draw(_shader)


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


def _make_shader() -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.typedef_source(_STRUCT)
    info.uniform_buf(0, "Look", "look")
    info.vertex_in(0, "VEC3", "position")
    info.vertex_in(1, "VEC3", "normal")
    between = gpu.types.GPUStageInterfaceInfo("fairing_stripes")
    between.smooth("VEC3", "at")
    between.smooth("VEC3", "turned")
    info.vertex_out(between)
    info.fragment_out(0, "VEC4", "colour")
    info.vertex_source(_VERTEX)
    info.fragment_source(_FRAGMENT)
    return gpu.shader.create_from_info(info)


def _note_changes(_scene: Any, depsgraph: bpy.types.Depsgraph) -> None:
    """Throws away what no longer fits, also where a modifier has looked at another object."""
    if not _entries:
        return
    changed = changed_keys(depsgraph, moved=False)
    for reference in _shown or ():
        target = reference.find()
        if target is None or changed & {session_key(target), session_key(target.data)}:
            _entries.pop(reference.key, None)


def _forget(*_: Any) -> None:
    global _shown
    _shown = None
    _entries.clear()


_HANDLERS = {
    "depsgraph_update_post": _note_changes,
    "frame_change_post": _forget,
    "undo_post": _forget,
    "redo_post": _forget,
    "load_pre": _forget,
    "load_post": _forget,
}


def _start() -> None:
    """From a timer: while Blender starts there is no graphics card yet."""
    global _shader, _handle
    _shader = _make_shader()
    _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW")


def register() -> None:
    if bpy.app.background:
        return
    # persistent: Blender may be about to open a file, which ends other timers
    bpy.app.timers.register(_start, first_interval=0.0, persistent=True)
    events.listen(_HANDLERS)


def unregister() -> None:
    global _shader, _handle
    if bpy.app.background:
        return
    events.ignore(_HANDLERS)
    if bpy.app.timers.is_registered(_start):
        bpy.app.timers.unregister(_start)
    if _handle is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
    _shader = _handle = None
    _forget()
