# SPDX-License-Identifier: GPL-3.0-or-later
"""Four models as they are blocked out, under Subdivision Surface and faired, both as they come: clay and zebra.

    .venv/bin/python examples/render_modelling.py           all of them, to docs/images/modelling/
    .venv/bin/python examples/render_modelling.py mug       only those named

Rendered by Cycles on the processor, some ten seconds a tile.
"""

import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

import jobs  # noqa: E402
import settings_meshes  # noqa: E402
from jobs import subdivided  # noqa: E402
from render_row import View, draw_rows, render_tile  # noqa: E402

OUT = ROOT / "docs" / "images" / "modelling"


MODELS = {
    "hull": (jobs.hull, View(8.4, turn=-132, elevation=16, height=0.85)),
    "fender": (
        jobs.fender,
        View(2.9, turn=-28, elevation=14, height=0.58),
    ),
    "mug": (
        jobs.mug,
        View(3.4, turn=-40, elevation=22, height=1.0),
    ),
    "suzanne": (settings_meshes.suzanne, View(3.1, turn=20, height=0.85)),
}


def faired(_control):
    bpy.ops.object.fairing_surface()
    return bpy.context.active_object


TILES = (
    ("As modelled", "clay", None),
    ("Subdivision Surface", "clay", subdivided),
    ("Fair Surface", "clay", faired),
    ("Subdivision Surface", "zebra", subdivided),
    ("Fair Surface", "zebra", faired),
)


def draw_tile(name, label, look, finish, path):
    make, view = MODELS[name]
    control = make()
    surface = finish(control) if finish else control
    render_tile(path, label, replace(view, look=look), control, [surface], finish is None)


ROWS = {name: [partial(draw_tile, name, *tile) for tile in TILES] for name in MODELS}

if __name__ == "__main__":
    draw_rows(sys.argv[1:], ROWS, OUT)
