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

import control_meshes  # noqa: E402
import modelling_meshes  # noqa: E402
import settings_meshes  # noqa: E402
from render_row import View, draw_rows, render_tile  # noqa: E402

OUT = ROOT / "docs" / "images" / "modelling"
LEVELS = 3


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


MODELS = {
    "hull": (modelled(control_meshes.hull), View(8.4, turn=-132, elevation=16, height=0.85)),
    "fender": (
        modelled(modelling_meshes.fender),
        View(2.9, turn=-28, elevation=14, height=0.58),
    ),
    "mug": (
        modelled(modelling_meshes.mug),
        View(3.4, turn=-40, elevation=22, height=1.0),
    ),
    "suzanne": (settings_meshes.suzanne, View(3.1, turn=20, height=0.85)),
}


def subdivided(control):
    """Blender's own, with its modifier's settings."""
    modifier = control.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = modifier.render_levels = LEVELS
    bpy.ops.object.shade_smooth()
    return control


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
