# SPDX-License-Identifier: GPL-3.0-or-later
"""Four models as they are blocked out, under Subdivision Surface and faired, both as they come: clay and zebra.

    .venv/bin/python examples/render_modelling.py           all of them, to docs/images/modelling/
    .venv/bin/python examples/render_modelling.py mug       only those named

Rendered by Cycles on the processor, some ten seconds a tile.
"""

import sys
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

import control_meshes  # noqa: E402
import modelling_meshes  # noqa: E402
import settings_meshes  # noqa: E402
from render_row import View, compose_row, render_tile  # noqa: E402

import addon  # noqa: E402

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
    "fender": (modelled(modelling_meshes.fender), View(2.9, turn=-28, elevation=14, height=0.58)),
    "mug": (modelled(modelling_meshes.mug), View(3.4, turn=-40, elevation=22, height=1.0)),
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


def main(names):
    unknown = {*names} - {*MODELS}
    if unknown:
        sys.exit(f"No such picture: {', '.join(sorted(unknown))}. There are {', '.join(MODELS)}.")
    OUT.mkdir(parents=True, exist_ok=True)
    addon.register()
    try:
        for name in names or MODELS:
            draw(*MODELS[name], OUT / f"{name}.png")
    finally:
        addon.unregister()  # the module bpy would hang at exit with classes of ours still registered


def draw(make, view, path):
    with TemporaryDirectory() as folder:
        tiles = [Path(folder) / f"{i}.png" for i in range(len(TILES))]
        for tile, (label, look, finish) in zip(tiles, TILES, strict=True):
            bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
            control = make()
            surface = finish(control) if finish else control
            seen = replace(view, look=look)
            render_tile(tile, label, seen, control, [surface], finish is None)
        compose_row(tiles, path)
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size // 1000} kB", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
