# SPDX-License-Identifier: GPL-3.0-or-later
"""Control mesh, spline patches and stripes across their edges: the pictures of docs/trades/cad.md.

    .venv/bin/python examples/render_splines.py           all of them, to docs/images/splines/
    .venv/bin/python examples/render_splines.py hull      only those named

Rendered by Cycles on the processor, some ten seconds a tile.
"""

import sys
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

import demo_meshes  # noqa: E402
import discrete_fairing as df  # noqa: E402
import settings_meshes  # noqa: E402
from patch_meshes import edges, tessellated  # noqa: E402
from render_clay import CREASE, WIRE  # noqa: E402
from render_row import View, compose_row, render_tile  # noqa: E402

OUT = ROOT / "docs" / "images" / "splines"
LEVELS = 5
SMOOTH, CREASED = 0, 1  # kinds of edges

SHAPES = {
    "hull": (
        demo_meshes.hull,
        {},
        View(9.3, turn=-132, elevation=28, height=0.5, stripes=18),
    ),
    "branching": (
        demo_meshes.branching,
        {"energy": "total_curvature"},
        View(4.7, turn=45, elevation=17, height=1.95, stripes=6),
    ),
}


def main(names):
    unknown = {*names} - {*SHAPES}
    if unknown:
        sys.exit(f"No such picture: {', '.join(sorted(unknown))}. There are {', '.join(SHAPES)}.")
    OUT.mkdir(parents=True, exist_ok=True)
    for name in names or SHAPES:
        draw(*SHAPES[name], OUT / f"{name}.png")


def draw(make, options, view, path):
    mesh = make()
    points = mesh.vertices.copy()
    points[:, :2] -= (points.max(axis=0) + points.min(axis=0))[:2] / 2
    patches = df.fit_patches(
        points, mesh.faces, crease_edges=mesh.crease_edges, levels=LEVELS, force=True, **options
    )
    with TemporaryDirectory() as folder:
        tiles = [Path(folder) / f"{i}.png" for i in range(3)]
        control_tile(tiles[0], mesh, points, view)
        patch_tile(tiles[1], patches, view)
        stripes_tile(tiles[2], patches, view)
        compose_row(tiles, path)
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size // 1000} kB", flush=True)


def control_tile(path, mesh, points, view):
    _begin()
    control = settings_meshes.add(points.tolist(), mesh.faces, "Control mesh")
    creased = {frozenset(edge) for edge in mesh.crease_edges}
    values = [float(frozenset(edge.vertices) in creased) for edge in control.data.edges]
    layer = control.data.attributes.new("crease_edge", "FLOAT", "EDGE")
    layer.data.foreach_set("value", values)
    render_tile(path, "Control mesh", view, control, [control], True)


def patch_tile(path, patches, view):
    _begin()
    shown = tessellated(patches)
    edges(patches, [SMOOTH], WIRE, 0.0035 * view.span)
    edges(patches, [CREASED], CREASE, 0.008 * view.span)
    label = f"{len(patches)} spline patches"
    render_tile(path, label, replace(view, look="own"), shown, [shown], False)


def stripes_tile(path, patches, view):
    _begin()
    shown = tessellated(patches)
    render_tile(path, "Stripes across them", replace(view, look="zebra"), shown, [shown], False)


def _begin():
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


if __name__ == "__main__":
    main(sys.argv[1:])
