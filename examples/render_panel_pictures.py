# SPDX-License-Identifier: GPL-3.0-or-later
"""The small pictures beside the panel's choices, of surfaces of ours: addon/ui/setting_pictures/.

    .venv/bin/python examples/render_panel_pictures.py

`python3 build_tools/dev.py setup` makes `.venv`. Fairness: zebra stripes on a ring through twenty vertices, held at
points and softly. Vertices: sections through a sheet, with its vertices as dots. They have no background, and colours
that show on dark and light themes.
"""

import sys
from math import cos, pi, sin
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy
import discrete_fairing
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

import settings_meshes as meshes  # noqa: E402
from render_picture import load_pixels, save  # noqa: E402
from render_row import View, aim, place  # noqa: E402
from render_studio import build_studio, render  # noqa: E402
from render_zebra import dress_in_zebra  # noqa: E402

import addon  # noqa: E402

OUT = ROOT / "addon" / "ui" / "setting_pictures"
SIZE = 96  # pixels

RINGS = {
    f"{energy.title()}{name}": {"energy": energy, "pad_size": pad}
    for energy in ("THIN_PLATE", "TOTAL_CURVATURE", "MINIMUM_VARIATION")
    for name, pad in (("", 0.0), ("_Softly", 1.0))
    if not (energy == "MINIMUM_VARIATION" and pad)  # where pads change nothing
}
SHADES = 15  # of grey beside black: the files are a third as large
RING_VIEW = View(2.95, turn=18, elevation=52, height=0.37, stripes=3)

# of the sheet, along it, in heights of the picture; scattered as measured points are
HEIGHTS = (0.22, 0.60, 0.42, 0.84, 0.50, 0.62, 0.22)
EVEN = np.linspace(0.07, 0.93, len(HEIGHTS))
# of a body with bevelled rims: its top and its walls are flat
BODY = ((0.14, 0.10), (0.14, 0.62), (0.23, 0.80), (0.77, 0.80), (0.86, 0.62), (0.86, 0.10))
TOLERANCE = 0.075
SECTIONS = ("Exact", "Approximate", "Limit", "Flats")
SURFACE, VERTEX, CAGE = (0.25, 0.58, 0.92), (0.96, 0.55, 0.14), (0.55, 0.55, 0.55)
SAMPLES = 4  # a pixel's side


def ring(around=5, across=4, radius=0.4):
    """A torus of twenty vertices."""
    turns = [2 * pi * i / around for i in range(around)]
    points = [
        (r * cos(turn), r * sin(turn), radius * sin(2 * pi * j / across))
        for turn in turns
        for j in range(across)
        for r in [1 + radius * cos(2 * pi * j / across)]
    ]

    def vertex(i, j):
        return i % around * across + j % across

    faces = [
        (vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1))
        for i in range(around)
        for j in range(across)
    ]
    return meshes.add(points, faces)


def draw_ring(settings, path):
    """The ring under its stripes, in a scene of its own."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    control = ring()
    bpy.ops.object.fairing_surface(levels=4, interpolation="EXACT", **settings)
    surface = bpy.context.active_object
    place(RING_VIEW, [surface])
    build_studio(SIZE, SIZE)
    bpy.data.objects["Floor"].hide_render = control.hide_render = True
    aim(RING_VIEW)
    dress_in_zebra(surface, stripes=RING_VIEW.stripes)
    with TemporaryDirectory() as folder:
        tile = Path(folder) / "ring.png"
        render(tile, samples=32)
        save(np.rint(load_pixels(tile) * SHADES) / SHADES, path, alpha=True)


def sheet(line):
    """Vertices and faces of a sheet with a `line` of x and z along it, the same for all y."""
    across = range(-2, 3)
    points = [(x, y, z) for x, z in line for y in across]
    rows, columns = len(line) - 1, len(across) - 1
    corners = [i * len(across) + j for i in range(rows) for j in range(columns)]
    return np.array(points), [(c, c + len(across), c + len(across) + 1, c + 1) for c in corners]


def section(line, interpolation):
    """(n, 2) points of the surface in the middle of the sheet."""
    points, faces = sheet(line)
    settings = {"interpolation": interpolation, "tolerance": TOLERANCE}
    if interpolation == "flats":
        rows = np.arange(len(faces)).reshape(len(line) - 1, -1)
        settings = {"flat_faces": rows[::2].ravel(), "metric_exponent": 0.95}
    surface = discrete_fairing.fair(points, faces, levels=4, **settings).vertices
    middle = surface[np.abs(surface[:, 1]) < 1e-6]
    # around the middle of the picture's lower side: neither line turns back
    turn = (
        np.arctan2(middle[:, 2], 0.5 - middle[:, 0]) if interpolation == "flats" else middle[:, 0]
    )
    return middle[np.argsort(turn)][:, ::2]


def draw_section(name, path):
    """A section over the control polygon and its vertices."""
    line = BODY if name == "Flats" else list(zip(EVEN, HEIGHTS))
    cage = np.array(line)
    picture = np.zeros((SIZE, SIZE, 4), np.float32)
    lay(picture, along(cage, 0.012), CAGE, 0.8)
    lay(picture, along(section(line, name.lower()), 0.036), SURFACE, 1.0)
    if name == "Approximate":
        for vertex in cage:
            lay(
                picture,
                along(np.array([vertex - (0, TOLERANCE), vertex + (0, TOLERANCE)]), 0.012),
                VERTEX,
                0.9,
            )
    for vertex in cage:
        lay(picture, along(np.array([vertex, vertex]), 0.05), VERTEX, 1.0)
    save(picture, path, alpha=True)


def along(line, radius):
    """The share of each pixel within `radius` of a polygon (n, 2); the picture has height 1."""
    fine = SIZE * SAMPLES
    places = (np.arange(fine) + 0.5) / fine
    pixels = np.stack(np.meshgrid(places, 1 - places), axis=-1)
    inside = np.zeros((fine, fine), bool)
    for start, end in zip(line, line[1:]):
        way = end - start
        share = (pixels - start) @ way / max(way @ way, 1e-12)
        nearest = start + np.clip(share, 0, 1)[..., None] * way
        inside |= np.linalg.norm(pixels - nearest, axis=-1) < radius
    return inside.reshape(SIZE, SAMPLES, SIZE, SAMPLES).mean(axis=(1, 3), dtype=np.float32)


def lay(picture, cover, colour, strength):
    """Lays `colour` over the picture where `cover` is."""
    alpha = strength * cover
    total = alpha + picture[..., 3] * (1 - alpha)
    share = np.divide(alpha, total, out=np.zeros_like(total), where=total > 0)[..., None]
    picture[..., :3] = share * np.float32(colour) + (1 - share) * picture[..., :3]
    picture[..., 3] = total


def main():
    OUT.mkdir(exist_ok=True)
    addon.register()
    try:
        for name, settings in RINGS.items():
            draw_ring(settings, OUT / f"{name}.png")
        for name in SECTIONS:
            draw_section(name, OUT / f"{name}.png")
    finally:
        addon.unregister()  # the module bpy would hang at exit with classes of ours still registered


if __name__ == "__main__":
    main()
