# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair for …, from defaults, in a window: each purpose on a model of its kind, one click after the selection."""

import importlib
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness
import numpy as np

EVEN = np.linspace(-1, 1, 9)


def clear():
    for other in list(bpy.data.objects):
        bpy.data.objects.remove(other)


def made(name, points, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    found = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(found)
    return found


def sheet(height):
    """9 × 9 vertices over a square."""
    clear()
    points = [(x, y, height(x, y)) for x in EVEN for y in EVEN]
    cells = [(i, j) for i in range(8) for j in range(8)]
    return made(
        "Sheet",
        points,
        [(9 * i + j, 9 * i + 9 + j, 9 * i + 10 + j, 9 * i + 1 + j) for i, j in cells],
    )


def bonnet():
    return sheet(lambda x, y: 0.35 * (1 - 0.4 * x**2) * (1 - 0.25 * y**2))


def hull():
    return sheet(lambda x, y: 0.4 * (1 - 0.5 * (x + 0.2) ** 2) + 0.15 * y * np.exp(x))


def points():
    random = np.random.default_rng(1)
    return sheet(lambda x, y: 0.4 * np.cos(x) * np.cos(y) + 0.01 * random.standard_normal())


def bracket():
    clear()
    corners = [(x, y, z) for x in (-1, 1) for y in (-0.6, 0.6) for z in (0, 0.5)]
    return made(
        "Bracket",
        corners,
        [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)],
    )


def character():
    clear()
    bpy.ops.mesh.primitive_monkey_add()
    source = bpy.context.object
    source.modifiers.new("Subdivision", "SUBSURF").levels = 3
    return source


def scan():
    clear()
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5)
    source = bpy.context.object
    random = np.random.default_rng(1)
    for vertex in source.data.vertices:
        vertex.co *= 1 + 0.01 * random.standard_normal()
    return source


def off(target):
    radii = [vertex.co.length for vertex in target.data.vertices]
    return float(np.sqrt(np.mean((np.array(radii) - 1) ** 2)))


def one_click(purpose, model):
    """A generator that returns the source and what is active afterwards."""
    with bpy.context.temp_override(**harness.view()):
        source = model()
        bpy.context.view_layer.objects.active = source
        source.select_set(True)
        bpy.ops.view3d.view_selected()
    yield from harness.open_sidebar("Fairing")
    harness.photograph(f"job_{purpose.lower()}_before")
    with bpy.context.temp_override(**harness.view()):
        answer = bpy.ops.object.fairing_for("INVOKE_DEFAULT", purpose=purpose)
    assert answer <= {"FINISHED", "RUNNING_MODAL"}, answer
    running = importlib.import_module(f"{harness.EXTENSION}.queue").running
    calm = 0
    while calm < 10:  # one run may begin another
        calm = 0 if running() else calm + 1
        yield 0.2
    result = bpy.context.view_layer.objects.active
    if result.mode == "EDIT":
        with bpy.context.temp_override(**harness.view()):
            bpy.ops.object.mode_set(mode="OBJECT")
    elif result != source:
        with bpy.context.temp_override(**harness.view()):
            bpy.ops.object.fairing_inspect(mode="ZEBRA")
    yield 1.0
    harness.photograph(f"job_{purpose.lower()}")
    return source, result


def test_hull():
    source, surface = yield from one_click("HULL", hull)
    assert surface.discrete_fairing.source == source
    assert surface.discrete_fairing.energy == "MINIMUM_VARIATION"


def test_panel():
    source, surface = yield from one_click("PANEL", bonnet)
    assert surface.discrete_fairing.source == source
    assert surface.discrete_fairing.energy == "MINIMUM_VARIATION"


def test_mechanical():
    source, surface = yield from one_click("MECHANICAL", bracket)
    assert surface.discrete_fairing.source == source
    box = np.array([vertex.co for vertex in surface.data.vertices])
    assert np.abs(box.max(axis=0) - (1, 0.6, 0.5)).max() < 1e-3, "its folds stay sharp"


def test_character():
    source, surface = yield from one_click("CHARACTER", character)
    assert surface.discrete_fairing.source == source
    assert surface.discrete_fairing.interpolation == "LIMIT"


def test_points():
    source, surface = yield from one_click("POINTS", points)
    assert surface.discrete_fairing.source == source
    assert surface.discrete_fairing.interpolation == "EXACT"
    assert "Eased" in source.data.shape_keys.key_blocks


def test_scan_patch():
    source, same = yield from one_click("SCAN_PATCH", scan)
    assert same == source and len(source.data.polygons) == 5120
    assert off(source) < 0.004, off(source)


def test_the_menu_on_the_button():
    with bpy.context.temp_override(**harness.view()):
        source = bonnet()
        bpy.context.view_layer.objects.active = source
        source.select_set(True)
    yield from harness.open_sidebar("Fairing")
    region = harness.view()["region"]
    harness.xdotool("mousemove", region.x + region.width // 2, region.y + region.height // 2)
    yield 0.5
    before = harness.colours(harness.photograph("job_menu"))
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.wm.call_menu(name="VIEW3D_MT_fairing_for")
    yield 1.5
    assert harness.colours(harness.photograph("job_menu")) > before, "pictures have colours"
    harness.xdotool("key", "Escape")
    yield 0.5


harness.run_in_window(globals())
