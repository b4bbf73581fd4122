# SPDX-License-Identifier: GPL-3.0-or-later
"""Each job from defaults in a window, pressed with the mouse on a model of its kind, beside Blender's own tool for
it. Clicks are counted from the selection to the result and to the first stripes. Models and rivals are those of
examples/jobs.py."""

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[1] / "examples"))

import bpy
import harness
import jobs
import numpy as np

MOST_CLICKS = 3
# where buttons are in the sidebar, roughly: a share of its width, pixels from its top
PLACES = {
    "hull": (0.15, 115),
    "panel": (0.45, 115),
    "mechanical": (0.75, 115),
    "character": (0.15, 192),
    "scan": (0.45, 192),
    "points": (0.75, 192),
    "curves": (0.45, 40),
    "cad": (0.15, 115),
}
ZEBRA = (0.32, 380)
STEP = (0.25, 230)


def name_of_call(name):
    """The Python call of a job's button."""
    job = jobs.JOBS[name]
    options = ", ".join(f"{key}='{value}'" for key, value in job.options.items())
    return f"bpy.ops.{job.operator}({options}"


def selected(name):
    """The model, seen whole; a generator that returns it."""
    with bpy.context.temp_override(**harness.view()):
        model = jobs.begin(name)
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=0.6, type="ORBITRIGHT")
        bpy.ops.view3d.view_orbit(angle=0.4, type="ORBITUP")
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="the model is there")
    yield from harness.open_sidebar("Fairing")
    harness.photograph(f"job_{name}_before")
    return model


def one_click(name):
    """A generator that returns the model and the active object afterwards, in stripes, with the rivals beside."""
    model = yield from selected(name)
    clicks = harness.Clicks()
    yield from clicks.press(name_of_call(name), *PLACES[name])
    yield from jobs.waited()
    assert clicks.count == 1, "one from the selection to the result"
    harness.photograph(f"job_{name}")
    yield from clicks.press("bpy.ops.object.fairing_inspect(mode='ZEBRA'", *ZEBRA)
    assert clicks.count <= MOST_CLICKS
    result = bpy.context.view_layer.objects.active
    assert result.discrete_fairing_inspection.mode == "ZEBRA"
    yield 1.0
    harness.photograph(f"job_{name}_zebra")
    yield from beside(name, result)
    return model, result


def beside(name, result):
    """Ours and the rivals, in stripes and in clay; a generator."""
    with bpy.context.temp_override(**harness.view()):
        if result.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        others = jobs.add_rivals(name, result)
        jobs.in_stripes(*others)
        bpy.ops.object.select_all(action="DESELECT")
        for shown in (result, *others):
            shown.select_set(True)
        bpy.ops.view3d.view_selected()
        bpy.ops.object.select_all(action="DESELECT")
    yield 1.0
    harness.sidebar().tag_redraw()  # another object is active: its panel has another height
    yield 0.5
    harness.photograph(f"job_{name}_beside")


# a setting of each job's surface
SURFACES = {
    "hull": ("energy", "THIN_PLATE"),  # this one is closed, with flat ends
    "panel": ("interpolation", "LIMIT"),
    "mechanical": ("energy", "THIN_PLATE"),
    "character": ("interpolation", "LIMIT"),
    "points": ("interpolation", "EXACT"),
}


def test_surfaces():
    for name, (setting, value) in SURFACES.items():
        source, surface = yield from one_click(name)
        assert surface.discrete_fairing.source == source, name
        assert getattr(surface.discrete_fairing, setting) == value, name


def off(target):
    radii = [vertex.co.length for vertex in target.data.vertices]
    return float(np.sqrt(np.mean((np.array(radii) - 1) ** 2)))


def test_scan():
    source, same = yield from one_click("scan")
    assert same == source and len(source.data.polygons) == 5120
    assert off(source) < 0.4 * jobs.NOISE, off(source)


def test_curves():
    _curve, surface = yield from one_click("curves")
    cage = surface.discrete_fairing.source
    assert (
        len(cage.discrete_fairing_curves.curves) == 7 and not cage.discrete_fairing_curves.remarks
    )


def test_cad():
    """From the selected hull to a STEP file: the job, Export STEP, and Export in the file browser."""
    yield from selected("cad")
    clicks = harness.Clicks()
    yield from clicks.press(name_of_call("cad"), *PLACES["cad"])
    yield from jobs.waited()
    yield from clicks.press("bpy.ops.export_scene.fairing_step(", *STEP)
    path = Path(tempfile.mkdtemp()) / "hull.step"
    yield from harness.execute_browser(path)
    clicks.count += 1
    yield 0.5
    yield from jobs.waited()
    assert clicks.count <= MOST_CLICKS
    harness.photograph("job_cad")
    assert path.read_text(encoding="ascii").startswith("ISO-10303-21;")


harness.run_in_window(globals())
