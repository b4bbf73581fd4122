# SPDX-License-Identifier: GPL-3.0-or-later
"""The main job on real input: Fair Surface, headless, on Suzanne and on three control meshes of our own.

    .venv/bin/python examples/demo.py            all four
    .venv/bin/python examples/demo.py hull       only those named

Writes an OBJ and a .blend of each result and one picture of all of them to out/, and prints what it did. Needs the
modules `bpy` and `discrete_fairing`; `python3 build_tools/dev.py demo` installs them first.
"""

import json
import sys
import time
from dataclasses import dataclass, field
from math import radians
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

import demo_meshes  # noqa: E402
from demo_table import print_table, table_row  # noqa: E402
from quiet import quiet  # noqa: E402
from render_picture import compose, render_pair  # noqa: E402

import addon  # noqa: E402

OUT = ROOT / "out"


@dataclass(frozen=True)
class Exhibit:
    name: str
    settings: dict = field(default_factory=dict)
    turn: float = 0.0  # how it stands in the picture, degrees about the vertical
    tip: float = 0.0  # and towards the viewer
    stripes: int = 7


EXHIBITS = (
    Exhibit("Suzanne", {"levels": 3}, turn=24, tip=-6, stripes=4),
    Exhibit("Sphere", {"levels": 4}, turn=17),
    Exhibit("Hull", {"levels": 4}, turn=-65, tip=-30, stripes=12),
    Exhibit("Branching", {"levels": 4}, turn=45, stripes=5),
)


def main(names):
    known = [exhibit.name.lower() for exhibit in EXHIBITS]
    unknown = {name.lower() for name in names} - {*known}
    if unknown:
        sys.exit(f"No such shape: {', '.join(sorted(unknown))}. There are {', '.join(known)}.")
    chosen = {name.lower() for name in names or known}
    exhibits = [exhibit for exhibit in EXHIBITS if exhibit.name.lower() in chosen]
    OUT.mkdir(exist_ok=True)
    bpy.context.preferences.filepaths.save_version = 0  # no .blend1 beside a .blend
    addon.register()
    try:
        with TemporaryDirectory() as tiles:
            rows, pairs = zip(*(show(exhibit, tiles) for exhibit in exhibits), strict=True)
            with quiet():
                compose(pairs, OUT / "demo.png")
    finally:
        addon.unregister()  # the module bpy would hang at exit with classes of ours still registered
    print_table(rows)
    print(f"\nMeshes and the picture demo.png are in {OUT}")


def show(exhibit, tiles):
    """Fairs, saves and renders one exhibit; returns its row of the table and its two pictures."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    control = make(exhibit.name)
    start = time.perf_counter()
    bpy.ops.object.fairing_surface(shade_smooth=True, **exhibit.settings)
    seconds = time.perf_counter() - start
    result = bpy.context.active_object
    with quiet():
        save(exhibit.name.lower())
    row = figures(control, result, exhibit.settings["levels"], seconds)
    print(f"{exhibit.name}: faired in {seconds:.2f} s, rendering …", flush=True)
    turn, tip = radians(exhibit.turn), radians(exhibit.tip)
    with quiet():
        return row, render_pair(control, result, tiles, turn, tip, exhibit.stripes)


def make(name):
    """Makes the control mesh of that name the active object."""
    if name == "Suzanne":
        bpy.ops.mesh.primitive_monkey_add()
        return bpy.context.active_object
    shape = demo_meshes.SHAPES[name.lower()]()
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(shape.vertices.tolist(), [], shape.faces)
    if shape.crease_edges:
        creased = {tuple(sorted(edge)) for edge in shape.crease_edges}
        weights = [float(tuple(sorted(edge.vertices)) in creased) for edge in mesh.edges]
        mesh.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", weights)
    control = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(control)
    bpy.context.view_layer.objects.active = control
    control.select_set(True)
    return control


def save(name):
    """Writes the result, which is selected, as OBJ, and the whole scene as .blend."""
    bpy.ops.wm.obj_export(
        filepath=str(OUT / f"{name}.obj"), export_selected_objects=True, export_materials=False
    )
    bpy.ops.wm.save_as_mainfile(
        filepath=str(OUT / f"{name}.blend"), copy=True, check_existing=False
    )


def figures(control, result, levels, seconds):
    """The row of one exhibit in the table."""
    result.data.calc_loop_triangles()
    triangles = len(result.data.loop_triangles)
    report = json.loads(result.discrete_fairing.report)
    return table_row(control.name, len(control.data.polygons), levels, triangles, report, seconds)


if __name__ == "__main__":
    main(sys.argv[1:])
