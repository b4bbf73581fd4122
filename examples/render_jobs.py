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

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

import jobs  # noqa: E402
from render_modelling import MODELS  # noqa: E402
from render_row import View, draw_rows, render_tile  # noqa: E402

from addon.purposes import PURPOSES  # noqa: E402

OUT = ROOT / "docs" / "images" / "jobs"


def pressed(name):
    """The result of the job on its model."""

    def faired(_control):
        job = jobs.JOBS[name]
        bpy.ops.object.fairing_for(**job.options)
        if name == "scan":  # its faces stay, and with them their shading, which is flat
            jobs.shade_smooth(bpy.context.active_object)
        return bpy.context.active_object

    return faired


# the view of the model
VIEWS = {
    "hull": MODELS["hull"][1],
    "panel": MODELS["fender"][1],
    "mechanical": View(3.6, turn=-30, elevation=24, height=0.8),
    "character": MODELS["suzanne"][1],
    "scan": View(2.6, height=1.0),
    "points": View(3.3, turn=-30, elevation=24, height=0.3),
}


def words_of(name):
    """The name of the job in the menu."""
    purpose = jobs.JOBS[name].options["purpose"]
    words = next(words for key, words, *_ in PURPOSES if key == purpose)
    return words.split(" (")[0]


def tiles_of(name):
    ours = (words_of(name), pressed(name))
    candidates = [*jobs.JOBS[name].rivals.items(), ours]
    return (
        ("As modelled", "clay", None),
        *((label, look, finish) for look in ("clay", "zebra") for label, finish in candidates),
    )


def draw_tile(name, label, look, finish, path):
    view = VIEWS[name]
    control = jobs.JOBS[name].model()
    if finish is None and control.modifiers:
        control.modifiers.clear()
    surface = finish(control) if finish else control
    render_tile(path, label, replace(view, look=look), control, [surface], finish is None)


ROWS = {name: [partial(draw_tile, name, *tile) for tile in tiles_of(name)] for name in VIEWS}

if __name__ == "__main__":
    draw_rows(sys.argv[1:], ROWS, OUT)
