# SPDX-License-Identifier: GPL-3.0-or-later
"""The gallery: each shape as control mesh and as the surface of each energy, in clay, zebra stripes and curvature colours.

    .venv/bin/python examples/gallery.py                      all of them, to docs/images/gallery/
    .venv/bin/python examples/gallery.py octahedron hull      only those named
    .venv/bin/python examples/gallery.py sphere_from_four_points    the sphere through four points
    .venv/bin/python examples/gallery.py pads                 Bob on point forces and on pads

Bob, the cat's head, the hand, Spot and the fish are not part of the project: `--meshes FOLDER` says where `bob_small.ply`,
`cat_head.obj`, `hand_lowres.obj`, `spot_control_mesh.obj` and `fish_control_mesh.obj` are; those that are missing are
left out. Rendered by Cycles on the processor, some five seconds a tile.
"""

import argparse
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

import discrete_fairing as df  # noqa: E402
from gallery_picture import Column, draw  # noqa: E402
from gallery_shapes import SHAPES, Absent  # noqa: E402

import addon  # noqa: E402

IMAGES = ROOT / "docs" / "images"
ENERGIES = {
    "thin_plate": "thin plate",
    "total_curvature": "total curvature",
    "minimum_variation": "minimum variation",
}
HERO, PADS = "sphere_from_four_points", "pads"
# Of the pictures that are not a shape with every energy: the shape, the looks, and the columns.
SPECIAL = {
    HERO: (
        "tetrahedron",
        ("clay", "zebra"),
        {"thin plate": {}, "total curvature": {"energy": "total_curvature"}},
    ),
    PADS: (
        "bob",
        ("curvature",),
        {
            "point forces": {"pad_size": 0.0},
            "pads of ½": {"pad_size": 0.5},
            "pads of 1": {"pad_size": 1.0},
        },
    ),
}


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join([HERO, *SHAPES]))
    parser.add_argument(
        "--meshes", type=Path, help="the folder with the meshes that are not the project's"
    )
    parser.add_argument(
        "--energies",
        nargs="+",
        default=[*ENERGIES],
        choices=ENERGIES,
        help="the columns; all by default",
    )
    parser.add_argument(
        "--samples", type=float, default=1.0, help="of each picture, times the usual"
    )
    options = parser.parse_args()
    unknown = {*options.names} - {*SPECIAL, *SHAPES}
    if unknown:
        parser.error(f"no such picture: {', '.join(sorted(unknown))}")
    (IMAGES / "gallery").mkdir(parents=True, exist_ok=True)
    addon.register()  # curvature colours are kept in its properties
    for name in options.names or [*SPECIAL, *SHAPES]:
        picture(name, options)


def picture(name, options):
    """Draws one picture, or prints a message if its mesh is absent."""
    every_energy = {ENERGIES[energy]: {"energy": energy} for energy in options.energies}
    shape_name, looks, surfaces = SPECIAL.get(name, (name, None, every_energy))
    shape = SHAPES[shape_name]
    try:
        control = shape.make(options.meshes)
    except Absent as why:
        print(f"{name}: left out, {why}")
        return
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    columns = [
        Column(
            "control mesh", control.vertices, control.faces, control.crease_edges, is_control=True
        )
    ]
    for label, settings in surfaces.items():
        result = fair(control, shape.levels, settings)
        if result is not None:
            triangles, quads = result.faces
            faces = triangles.tolist() + quads.tolist()
            columns.append(
                Column(label, result.vertices, faces, creased=bool(len(control.crease_edges)))
            )
    path = IMAGES / (f"{name}.png" if name in SPECIAL else f"gallery/{name}.png")
    with TemporaryDirectory() as folder:
        draw(path, folder, columns, shape.view, looks, options.samples)
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size // 1000} kB", flush=True)


def fair(control, levels, settings):
    """The surface; None if total curvature or its variation is impossible."""
    creases = control.crease_edges if len(control.crease_edges) else None
    try:
        return df.fair(
            control.vertices,
            control.faces,
            levels=levels,
            crease_edges=creases,
            **settings,
        )
    except (ValueError, df.FairingError) as error:
        if "energy" not in settings:
            raise
        print(f"no {settings['energy']} here: {error}")
        return None


if __name__ == "__main__":
    main()
