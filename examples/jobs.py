# SPDX-License-Identifier: GPL-3.0-or-later
"""Each job on a model of its kind, by one click, beside Blender's own tool for that job; both in stripes.

    blender --python examples/jobs.py -- hull      in a Blender that has the extension

The jobs: hull, panel, mechanical, character, scan, points, curves, cad. Everything is as it comes.
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from math import radians
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

import curve_networks  # noqa: E402
import demo_meshes  # noqa: E402
import modelling_meshes  # noqa: E402
import settings_meshes  # noqa: E402

LEVELS = 3  # of Subdivision Surface, as Fair Surface has
NOISE = 0.004  # of the scanned ball's radius, root mean square
SCATTER = 0.012  # of the measured sheet's half width


@dataclass(frozen=True)
class Job:
    """`model()`: makes what the job is done on, selected and active. `operator`, `options`: what the
    button runs. `rivals`: what Blender has for it, by name; each takes the model and returns what it
    has made of it.
    """

    model: Callable[[], bpy.types.Object]
    operator: str
    options: dict[str, str] = field(default_factory=dict)
    rivals: dict[str, Callable[[bpy.types.Object], bpy.types.Object]] = field(default_factory=dict)


def modelled(make):
    """A control mesh of plain arrays as an object."""

    def made():
        mesh = make()
        points = mesh.vertices.copy()
        points[:, :2] -= (points.max(axis=0) + points.min(axis=0))[:2] / 2
        control = settings_meshes.add(points.tolist(), mesh.faces, "Model")
        creased = {frozenset(edge) for edge in mesh.crease_edges}
        if creased:
            values = [float(frozenset(edge.vertices) in creased) for edge in control.data.edges]
            layer = control.data.attributes.new("crease_edge", "FLOAT", "EDGE")
            layer.data.foreach_set("value", values)
        return control

    return made


def ball():
    """A scanned ball of 5,120 faces."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=1.0)
    control = bpy.context.object
    random = np.random.default_rng(5)
    for vertex in control.data.vertices:
        vertex.co *= 1 + random.normal(0, NOISE)
    return control


def dome():
    """9 × 9 points on a dome over a square, measured with an error."""
    even = np.linspace(-1, 1, 9)
    x, y = np.meshgrid(even, even, indexing="ij")
    z = 0.55 * np.cos(1.2 * x) * np.cos(1.2 * y)
    z += np.random.default_rng(1).normal(0, SCATTER, z.shape)
    faces = [
        (9 * i + j, 9 * i + 9 + j, 9 * i + 10 + j, 9 * i + 1 + j)
        for i in range(8)
        for j in range(8)
    ]
    return settings_meshes.add(np.stack([x, y, z], axis=2).reshape(-1, 3).tolist(), faces, "Dome")


def bezier(name, points, closed=False):
    """A curve with automatic handles, as drawn by hand."""
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("BEZIER")
    spline.bezier_points.add(len(points) - 1)
    spline.use_cyclic_u = closed
    for row, point in zip(spline.bezier_points, points, strict=True):
        row.co = point
        row.handle_left_type = row.handle_right_type = "AUTO"
    made = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(made)
    return made


def drawn(network):
    """A network of curves, all of them selected."""
    curves = [bezier(*curve) for curve in network()]
    for curve in curves:
        curve.select_set(True)
    bpy.context.view_layer.objects.active = curves[0]
    return curves[0]


def cage():
    """Adds Suzanne as a cage."""
    return subdivided(settings_meshes.suzanne())


def subdivided(control):
    """Blender's Subdivision Surface, with the modifier's own settings."""
    modifier = control.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = modifier.render_levels = LEVELS
    shade_smooth(control)
    return control


def creased(control):
    """Subdivision Surface, creased and sharp at the edges that Mechanical keeps: those folded by 30° and
    more.
    """
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.mesh.select_mode(type="EDGE")
    bpy.ops.mesh.edges_select_sharp(sharpness=radians(30))
    bpy.ops.transform.edge_crease(value=1.0)
    bpy.ops.mesh.mark_sharp()
    bpy.ops.object.mode_set(mode="OBJECT")
    return subdivided(control)


def smoothed(control):
    """Blender's Laplacian Smooth, at the best of 18 settings for this noise."""
    modifier = control.modifiers.new("Laplacian Smooth", "LAPLACIANSMOOTH")
    modifier.iterations, modifier.lambda_factor, modifier.lambda_border = 3, 1.0, 0.0
    shade_smooth(control)
    return control


def shrinkwrapped(control):
    """A clean ball, drawn onto the scan, and smoothed by Subdivision Surface."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=1.1)
    clean = bpy.context.object
    wrap = clean.modifiers.new("Shrinkwrap", "SHRINKWRAP")
    wrap.target = control
    control.hide_set(True)
    return subdivided(clean)


def grid_filled(control):
    """Grid Fill between the four outer curves, which are all that it uses, with as many segments."""
    outer = [curve for curve in bpy.context.selected_objects if curve.type == "CURVE"]
    ways = {"Row 0": False, "Column 3": False, "Row 2": True, "Column 0": True}
    points = np.concatenate([_along(bpy.data.objects[name], back) for name, back in ways.items()])
    count = len(points)
    mesh = bpy.data.meshes.new("Grid Fill")
    mesh.from_pydata(points.tolist(), [(i, (i + 1) % count) for i in range(count)], [])
    filled = bpy.data.objects.new("Grid Fill", mesh)
    bpy.context.collection.objects.link(filled)
    for other in outer:
        other.select_set(False)
        other.hide_set(True)
    bpy.context.view_layer.objects.active = filled
    filled.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.fill_grid(span=count // 4)
    bpy.ops.object.mode_set(mode="OBJECT")
    shade_smooth(filled)
    return filled


def _along(curve, back, count=24):
    """(count, 3) places on a drawn curve, all but its last."""
    mesh = curve.to_mesh()
    points = np.array([vertex.co for vertex in mesh.vertices])
    curve.to_mesh_clear()
    points = points[::-1] if back else points
    steps = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = np.linspace(0, steps[-1], count + 1)[:-1]
    return np.stack([np.interp(at, steps, points[:, axis]) for axis in range(3)], axis=1)


def shade_smooth(target):
    target.data.polygons.foreach_set("use_smooth", [True] * len(target.data.polygons))


SUBDIVISION = {"Subdivision Surface": subdivided}
FAIR_FOR = "object.fairing_for"
hull, fender = modelled(demo_meshes.hull), modelled(modelling_meshes.fender)
mug = modelled(modelling_meshes.mug)

JOBS = {
    "hull": Job(hull, FAIR_FOR, {"purpose": "HULL"}, SUBDIVISION),
    "panel": Job(fender, FAIR_FOR, {"purpose": "PANEL"}, SUBDIVISION),
    "mechanical": Job(
        partial(settings_meshes.can, sides=16),
        FAIR_FOR,
        {"purpose": "MECHANICAL"},
        {"Subdivision Surface, creased": creased},
    ),
    "character": Job(
        cage,
        FAIR_FOR,
        {"purpose": "CHARACTER"},
        {"Subdivision Surface": lambda control: control},  # the cage has it already
    ),
    "scan": Job(
        ball,
        FAIR_FOR,
        {"purpose": "SCAN_PATCH"},
        {"Laplacian Smooth": smoothed, "Shrinkwrap": shrinkwrapped},
    ),
    "points": Job(dome, FAIR_FOR, {"purpose": "POINTS"}, SUBDIVISION),
    "curves": Job(
        partial(drawn, curve_networks.crossing),
        "object.fairing_curves",
        {},
        {"Grid Fill": grid_filled},
    ),
    # Blender writes no STEP
    "cad": Job(hull, FAIR_FOR, {"purpose": "HULL"}),
}


def begin(name):
    """An empty scene with the job's model, which is returned."""
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for other in list(bpy.data.objects):
        bpy.data.objects.remove(other)
    return JOBS[name].model()


def press(name):
    """Runs the operator of the job's button."""
    job = JOBS[name]
    folder, operator = job.operator.split(".")
    return getattr(getattr(bpy.ops, folder), operator)("INVOKE_DEFAULT", **job.options)


def add_rivals(name, ours):
    """Adds Blender's own results, each on a model of its own, in a row beside ours, in Object Mode; returns
    them.
    """
    found = []
    size = ours.dimensions
    across = 1 if size.z < size.y < size.x else 0  # beside what is long, if it hides nothing
    width = 1.25 * size[across]
    for make in JOBS[name].rivals.values():
        before = set(bpy.data.objects)
        for other in bpy.context.selected_objects:
            other.select_set(False)
        surface = make(JOBS[name].model())
        for new in set(bpy.data.objects) - before:
            new.location[across] += width * (len(found) + 1)
        found.append(surface)
    return found


def in_stripes(*surfaces):
    for surface in surfaces:
        surface.discrete_fairing_inspection.mode = "ZEBRA"


def view():
    """The 3D viewport of the window, as temp_override takes it."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    return {"window": window, "screen": window.screen, "area": area, "region": region}


def show(name):
    """Runs the whole job in a window: a generator that waits at each yield."""
    with bpy.context.temp_override(**view()):
        begin(name)
        bpy.ops.view3d.view_selected()
        press(name)
    yield from waited()
    with bpy.context.temp_override(**view()):
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        ours = bpy.context.view_layer.objects.active
        in_stripes(ours, *add_rivals(name, ours))
        ours.select_set(True)
        bpy.ops.view3d.view_all()


def waited():
    """Waits until all runs have ended, since one run may begin another."""
    queue = next(m for n, m in sys.modules.items() if n.endswith("discrete_fairing.queue"))
    calm = 0
    while calm < 10:
        calm = 0 if queue.running() else calm + 1
        yield 0.2


if __name__ == "__main__":
    chosen = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    if len(chosen) != 1 or chosen[0] not in JOBS:
        raise SystemExit(f"Say which job after --: {', '.join(JOBS)}")
    walk = show(chosen[0])
    bpy.app.timers.register(lambda: next(walk, None), first_interval=1.0)
