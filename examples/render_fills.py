# SPDX-License-Identifier: GPL-3.0-or-later
"""Holes, and what closes them: as they are, by Blender's own Fill, by MeshLib, by CGAL, and by Fill Hole
Fair. What fills a hole has a colour of its own.

    .venv/bin/python examples/render_fills.py               all of them, to docs/images/filling/
    .venv/bin/python examples/render_fills.py saddle        only those named

Needs what the benchmark `fills` needs, else the picture is left as it is. Rendered by Cycles on the processor, some ten seconds a tile.
"""

import sys
from functools import cache, partial
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
# benchmarks before examples, which has control meshes of its own
sys.path[:0] = [str(ROOT / name) for name in ("", "benchmarks", "examples", "tests/python")]

import discrete_fairing as df  # noqa: E402
import fill_rivals  # noqa: E402
import fill_shapes  # noqa: E402
import from_tests  # noqa: E402
from ragged_holes import cut, largest_piece  # noqa: E402
from render_clay import clay, matte  # noqa: E402
from render_row import View, draw_rows, render_tile  # noqa: E402

OUT = ROOT / "docs" / "images" / "filling"
FILLED = (0.72, 0.25, 0.07)
LIMIT = 300.0  # seconds


def known(name):
    """A shape of the benchmark."""

    def arrays():
        holed = fill_shapes.SHAPES[name]()
        return holed.vertices, holed.faces, holed.hole

    return arrays


def scan():
    """Suzanne's head without the eyes, with a ragged hole in the forehead."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_monkey_add()
    target = bpy.context.object
    modifier = target.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = 2
    mesh = target.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    mesh.calc_loop_triangles()
    vertices = np.array([v.co for v in mesh.vertices], float)
    faces = np.array([t.vertices for t in mesh.loop_triangles])
    vertices, faces = cut(vertices, faces, ~largest_piece(faces))
    middle = [-0.05, -0.55, 0.85]
    away = np.linalg.norm(vertices[faces].mean(1) - middle, axis=1)
    gone = away < 0.24 + 0.08 * np.random.default_rng(4).random(len(faces))
    rest = np.flatnonzero(~gone)
    gone[rest[~largest_piece(faces[rest])]] = True
    vertices, faces = cut(vertices, faces, gone)
    loops = df.find_holes(vertices, faces)  # the eyes' sockets are two of them
    return vertices, faces, min(loops, key=lambda h: np.linalg.norm(vertices[h].mean(0) - middle))


def mug():
    """A mug without its bottom, upside down."""
    control = from_tests.modelled().mug()
    result = df.fair(control.vertices, control.faces, levels=2, measure=False)
    vertices, faces = result.vertices, result.triangles.astype(np.int64)
    corner = vertices[faces]
    gone = (corner[:, :, 2].max(1) < 0.05) & (
        np.linalg.norm(corner[:, :, :2], axis=2).max(1) < 0.75
    )
    vertices, faces = cut(vertices * [1, -1, -1], faces, gone)
    return vertices, faces, max(df.find_holes(vertices, faces), key=len)


MODELS = {
    "half_sphere": (known("half sphere"), View(3.0, elevation=22, height=0.9)),
    "torus": (known("torus, bite"), View(6.6, turn=-65, elevation=32, height=0.7)),
    "saddle": (known("saddle"), View(3.1, turn=30, elevation=38, height=0.45)),
    "scan": (scan, View(3.1, turn=12, elevation=14, height=0.95)),
    "mug": (mug, View(3.4, turn=-40, elevation=38, height=1.0)),
}
TILES = {
    "Open": None,
    "Blender: Fill": "Blender, Fill",
    "MeshLib": "MeshLib",
    "CGAL": "CGAL, C2",
    "Fill Hole Fair": "total curvature",
}


@cache
def arrays_of(name):
    return MODELS[name][0]()


def draw_tile(name, label, maker, path):
    given = arrays_of(name)
    vertices, faces = given[:2]
    if maker is not None:
        made = fill_rivals.made(maker, given, LIMIT)
        if isinstance(made, str):
            print(f"{label}: {made}. The picture is left as it is.")
            sys.exit()
        vertices, faces = made[:2]
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    old = {tuple(sorted(face)) for face in given[1].tolist()}
    mesh = bpy.data.meshes.new(label)
    mesh.from_pydata(vertices.tolist(), [], faces.tolist())
    for material in (clay(), matte("Filling", FILLED, roughness=0.5)):
        mesh.materials.append(material)
    for face in mesh.polygons:
        face.material_index = tuple(sorted(face.vertices)) not in old
    mesh.shade_smooth()
    target = bpy.data.objects.new(label, mesh)
    bpy.context.scene.collection.objects.link(target)
    view = MODELS[name][1]
    render_tile(path, label, View(**{**vars(view), "look": "own"}), target, [target], False)


ROWS = {name: [partial(draw_tile, name, *tile) for tile in TILES.items()] for name in MODELS}

if __name__ == "__main__":
    draw_rows(sys.argv[1:], ROWS, OUT)
