# SPDX-License-Identifier: GPL-3.0-or-later
"""A sample .blend file for each trade: the mesh, its surface, and a text that says what to try. Part of a release.

.venv/bin/python examples/sample_files.py FOLDER
"""

import sys
from functools import partial
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

import jobs  # noqa: E402
from quiet import quiet  # noqa: E402
from trade_pages import scripted  # noqa: E402

import addon  # noqa: E402

FIRST = "Open the sidebar (N), tab Fairing."
LEVELS = 2  # of the surfaces, so that the files are small


def pressed(name):
    """A job's model and its surface."""
    jobs.begin(name).name = name.title()
    bpy.ops.object.fairing_for(**jobs.JOBS[name].options)
    return bpy.context.active_object


# by the file's name: what makes its objects, and what to try
SAMPLES = {
    "hull": (
        partial(scripted, "trades/hull", 2),
        "One offset is misread: press Zebra in Inspect, then open Strain and switch on Show Strain.",
    ),
    "panel": (
        partial(scripted, "trades/panel", 3),
        "Press Zebra in Inspect. Switch on Live, press Show Source and drag vertices in Edit Mode.",
    ),
    "character": (
        partial(pressed, "character"),
        "Change Follow, and press Recompute.",
    ),
    "scan": (
        partial(scripted, "trades/scan"),
        "Press Fill Hole Fair, then click Scan Patch under Fair for.",
    ),
    "machine_part": (
        partial(pressed, "mechanical"),
        "Change Crease Angle, and press Recompute.",
    ),
    "cad": (
        partial(scripted, "trades/cad"),
        "Press Show Patches, or choose File > Export > Fair Surface (.step).",
    ),
    "scan_to_cad": (
        partial(scripted, "how-to/scan-to-cad", 2),
        "Open Inspect, and choose Deviation.",
    ),
}


def look_at(target):
    """Sets each viewport of the file to show the whole object."""
    corners = [target.matrix_world @ vertex.co for vertex in target.data.vertices]
    low, high = (type(corners[0])(map(which, zip(*corners, strict=True))) for which in (min, max))
    for screen in bpy.data.screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                view = area.spaces.active.region_3d
                view.view_location, view.view_distance = (low + high) / 2, 1.6 * (high - low).length


def write(name, folder):
    """Writes one file and returns its path."""
    make, what_to_try = SAMPLES[name]
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.context.scene.discrete_fairing.levels = LEVELS
    target = make()
    text = bpy.data.texts.new("Read me")
    text.write(f"{FIRST}\n{what_to_try}\n")
    look_at(target)
    path = folder / f"{name}.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True)
    return path


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    addon.register()
    try:
        for name in SAMPLES:
            with quiet():
                path = write(name, folder.resolve())
            print(f"{path.name}: {path.stat().st_size // 1000} kB", flush=True)
    finally:
        addon.unregister()  # the module bpy would hang at exit with classes of ours still registered


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    main(Path(sys.argv[1]))
