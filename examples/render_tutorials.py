# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of docs/trades/, of the very meshes that their scripts make.

    .venv/bin/python examples/render_tutorials.py           all of them, to docs/images/tutorials/
    .venv/bin/python examples/render_tutorials.py hull      only those named

Rendered by Cycles on the processor, some ten seconds a tile.
"""

import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

from render_row import View, draw_rows, render_tile  # noqa: E402
from trade_pages import scripted  # noqa: E402

OUT = ROOT / "docs" / "images" / "tutorials"
HULL = View(5.2, turn=168, elevation=14, height=0.6, stripes=24)
FENDER = View(2.9, turn=-28, elevation=14, height=0.58, stripes=14)
BOAT = View(6.3, turn=236, elevation=26, height=0.7)
SCAN = View(2.5, turn=20, elevation=12, height=1.0)
MISREAD, MEANT = 22, 0.70  # the vertex of the hull, and its half-breadth


def centred(target):
    """Puts the middle of `target` above the origin, where the camera looks."""
    corners = [vertex.co for vertex in target.data.vertices]
    for axis in (0, 1):
        values = [co[axis] for co in corners]
        target.location[axis] -= (min(values) + max(values)) / 2
    return target


def draw_hull(label, look, corrected, path):
    hull = centred(scripted("trades/hull"))
    if corrected:
        hull.data.vertices[MISREAD].co.y = MEANT
    bpy.ops.object.fairing_for(purpose="HULL")
    surface = bpy.context.active_object
    render_tile(path, label, replace(HULL, look=look), hull, [surface], False)


def draw_fender(label, look, scripts, path):
    surface = centred(scripted("trades/panel", scripts))
    control = surface.discrete_fairing.source or surface
    render_tile(path, label, replace(FENDER, look=look), control, [surface], control is surface)


def draw_scan(label, look, steps, path):
    scan = scripted("trades/scan")
    if steps > 0:
        bpy.ops.object.fairing_fill()
    if steps > 1:
        bpy.ops.object.fairing_for(purpose="SCAN_PATCH")
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.shade_smooth()
    render_tile(path, label, replace(SCAN, look=look), scan, [scan], False)


def draw_boat(label, modelled, path):
    """The whole hull without the misread offset: its control mesh, or its surface."""
    hull = centred(scripted("trades/hull"))
    hull.data.vertices[MISREAD].co.y = MEANT
    bpy.ops.object.fairing_for(purpose="HULL")
    half = bpy.context.active_object
    bpy.ops.object.fairing_close()
    surface = bpy.context.active_object
    hull.hide_render = half.hide_render = surface.hide_render = True
    control = surface.discrete_fairing.source
    shown = control if modelled else surface
    shown.hide_set(False)
    shown.hide_render = False
    render_tile(path, label, BOAT, control, [shown], modelled)


ROWS = {
    "hero": [
        partial(draw_boat, "Hull, 40 points", True),
        partial(draw_fender, "Panel, 54 points", "clay", 1),
        partial(draw_scan, "Scan with a hole", "clay", 0),
        partial(draw_boat, "Fair Surface", False),
        partial(draw_fender, "Fair Surface", "clay", 2),
        partial(draw_scan, "Filled, without noise", "clay", 2),
    ],
    "hull": [
        partial(draw_hull, "0.76, as read", "zebra", False),
        partial(draw_hull, "0.70", "zebra", True),
    ],
    "fender": [
        partial(draw_fender, "As modelled", "clay", 1),
        partial(draw_fender, "Panel", "clay", 2),
        partial(draw_fender, "Panel", "zebra", 2),
        partial(draw_fender, "With a sharp arch", "zebra", 3),
    ],
    "scan": [
        partial(draw_scan, "A scan", "clay", 0),
        partial(draw_scan, "Filled", "clay", 1),
        partial(draw_scan, "Filled", "zebra", 1),
        partial(draw_scan, "Without noise", "zebra", 2),
    ],
}

if __name__ == "__main__":
    draw_rows(sys.argv[1:], ROWS, OUT, {"hero": 3})
