# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves, the control mesh over them and the surface in stripes: the pictures of docs/how-to/curves.md.

    .venv/bin/python examples/render_curves.py           all of them, to docs/images/curves/
    .venv/bin/python examples/render_curves.py hull      only those named

Rendered by Cycles on the processor, some ten seconds a tile.
"""

import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

import curve_networks  # noqa: E402
import jobs  # noqa: E402
from render_clay import matte  # noqa: E402
from render_row import View, draw_rows, render_tile  # noqa: E402

OUT = ROOT / "docs" / "images" / "curves"
THICKNESS = 0.012  # of a curve, a share of the view
LINE = (0.05, 0.16, 0.42)
LEVELS = 4

SHAPES = {
    "crossing": (curve_networks.crossing, View(3.3, turn=28, elevation=35, height=0.3, stripes=9)),
    "hull": (curve_networks.hull, View(3.6, turn=38, elevation=24, height=0.4, stripes=9)),
}


def main(names):
    rows = {
        name: [partial(draw_tile, make, view, part) for part in ("curves", "mesh", "surface")]
        for name, (make, view) in SHAPES.items()
    }
    draw_rows(names, rows, OUT)


def draw_tile(make, view, part, path):
    curves = [jobs.bezier(*curve) for curve in make()]
    for curve in curves:
        curve.select_set(True)
    bpy.context.view_layer.update()
    assert bpy.ops.object.fairing_curves(levels=LEVELS) == {"FINISHED"}
    surface = bpy.context.active_object
    mesh = surface.discrete_fairing.source
    for curve in curves:
        curve.data.bevel_depth = THICKNESS * view.span / 2 * (0.5 if part == "surface" else 1.0)
        curve.hide_render = part == "mesh"
        curve.data.materials.append(matte("Curve", LINE, roughness=0.8))
    mesh.hide_set(False)
    if part == "curves":
        surface.hide_render = True
        render_tile(path, f"{len(curves)} curves", view, mesh, [surface], False)
    elif part == "mesh":
        surface.hide_render = True
        label = f"{len(mesh.data.polygons)} faces over them"
        render_tile(path, label, view, mesh, [mesh], True)
    else:
        zebra = replace(view, look="zebra")
        render_tile(path, "The surface in stripes", zebra, mesh, [surface], False)


if __name__ == "__main__":
    main(sys.argv[1:])
