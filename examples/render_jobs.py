# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair for …, each job in one click on a model of its kind, beside what Blender has for it: clay and zebra.

.venv/bin/python examples/render_jobs.py             all of them, to docs/images/jobs/
.venv/bin/python examples/render_jobs.py hull scan   only those named
"""

import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

import settings_meshes  # noqa: E402
from render_modelling import MODELS, subdivided  # noqa: E402
from render_row import View, draw_rows, render_tile  # noqa: E402

OUT = ROOT / "docs" / "images" / "jobs"
NOISE = 0.004  # of the scanned ball's radius, root mean square
SCATTER = 0.012  # of the measured sheet's half width
SMOOTHINGS = 10


def ball():
    """A scanned ball of 5,120 faces."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=1.0)
    control = bpy.context.object
    random = np.random.default_rng(5)
    for vertex in control.data.vertices:
        vertex.co *= 1 + random.normal(0, NOISE)
    return control


def dome():
    """9 × 9 points, measured with an error, on a dome over a square."""
    even = np.linspace(-1, 1, 9)
    x, y = np.meshgrid(even, even, indexing="ij")
    z = 0.55 * np.cos(1.2 * x) * np.cos(1.2 * y)
    z += np.random.default_rng(1).normal(0, SCATTER, z.shape)
    faces = [
        (9 * i + j, 9 * i + 9 + j, 9 * i + 10 + j, 9 * i + 1 + j)
        for i in range(8)
        for j in range(8)
    ]
    return settings_meshes.add(np.stack([x, y, z], axis=2).reshape(-1, 3).tolist(), faces, "Dome")


def smoothed(control):
    """Smooth Vertices, repeated."""
    modifier = control.modifiers.new("Smooth", "SMOOTH")
    modifier.factor, modifier.iterations = 0.5, SMOOTHINGS
    bpy.ops.object.shade_smooth()
    return control


def for_job(purpose, prepare=None):
    def faired(control):
        if prepare:
            prepare(control)
        bpy.ops.object.fairing_for(purpose=purpose)
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
            bpy.ops.object.shade_smooth()
        return bpy.context.active_object

    return faired


# the model and how it is seen; Blender's way, and its name; the job, and what it begins with
JOBS = {
    "hull": (*MODELS["hull"], ("Subdivision Surface", subdivided), ("Hull", None)),
    "panel": (*MODELS["fender"], ("Subdivision Surface", subdivided), ("Panel", None)),
    "mechanical": (
        partial(settings_meshes.can, sides=16),
        View(3.6, turn=-30, elevation=24, height=0.8),
        ("Subdivision Surface", subdivided),
        ("Mechanical", None),
    ),
    "character": (
        *MODELS["suzanne"],
        ("Subdivision Surface", subdivided),
        ("Character", subdivided),  # as the modeller of a cage has it
    ),
    "scan": (
        ball,
        View(2.6, height=1.0),
        (f"Smooth, {SMOOTHINGS} times", smoothed),
        ("Scan Patch", None),
    ),
    "points": (
        dome,
        View(3.3, turn=-30, elevation=24, height=0.3),
        ("Subdivision Surface", subdivided),
        ("Points", None),
    ),
}


def tiles_of(job):
    _make, _view, (rival, finish), (purpose, prepare) = JOBS[job]
    ours = for_job(purpose.upper().replace(" ", "_"), prepare)
    return (
        ("As modelled", "clay", None),
        (rival, "clay", finish),
        (f"For > {purpose}", "clay", ours),
        (rival, "zebra", finish),
        (f"For > {purpose}", "zebra", ours),
    )


def draw_tile(job, label, look, finish, path):
    make, view, *_ = JOBS[job]
    control = make()
    surface = finish(control) if finish else control
    render_tile(path, label, replace(view, look=look), control, [surface], finish is None)


ROWS = {job: [partial(draw_tile, job, *tile) for tile in tiles_of(job)] for job in JOBS}

if __name__ == "__main__":
    draw_rows(sys.argv[1:], ROWS, OUT)
