# SPDX-License-Identifier: GPL-3.0-or-later
"""Dots, needles and labels of strain over the viewport: in Object and Edit Mode, and while Live is on."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness
import numpy as np

ROWS, COLUMNS, WRONG = 9, 7, 31


def blue(name):
    """How many pixels of the viewport have the colour of the longest needle, inwards, seen through the sheet."""
    r, g, b = harness.pixels(name).astype(int).transpose(2, 0, 1)
    return int(np.count_nonzero((b > 120) & (b - r > 60) & (g > r) & (g < b)))


def sheet():
    """A smooth sheet of quads, one vertex of which stands out."""
    bpy.data.objects.remove(harness.add_suzanne())
    x, y = np.meshgrid(np.linspace(0, 8, ROWS), np.linspace(0, 6, COLUMNS), indexing="ij")
    points = np.stack([x, y, 0.4 * np.sin(0.5 * x) * np.cos(0.4 * y)], axis=2).reshape(-1, 3)
    points[WRONG, 2] += 0.1
    at = np.arange(ROWS * COLUMNS).reshape(ROWS, COLUMNS)
    faces = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], axis=2).reshape(-1, 4)
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(points.tolist(), [], faces.tolist())
    target = bpy.data.objects.new("Sheet", mesh)
    bpy.context.collection.objects.link(target)
    with bpy.context.temp_override(**harness.view()):
        bpy.context.view_layer.objects.active = target
        target.select_set(True)
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=0.5, type="ORBITRIGHT")
        bpy.ops.view3d.view_orbit(angle=0.6, type="ORBITUP")
        bpy.ops.view3d.view_selected()
        target.select_set(False)
        bpy.ops.ed.undo_push(message="A sheet is there")
    return target


def room():
    return harness.module("strain.cache")


def until_measured(target):
    """Waits for what is shown to be up to date; a generator."""
    yield 0.5
    yield from harness.until(
        lambda: not room().is_behind(target) and room().found_of(target) is not None
    )
    yield 1.0


def show(target):
    harness.call(bpy.ops.object.fairing_strain, "INVOKE_DEFAULT", target=target)


def test_dots_needles_and_labels():
    target = sheet()
    yield from harness.open_sidebar("Fairing")
    yield 0.5
    before = blue("strain_before")
    show(target)
    yield from until_measured(target)
    shown = blue("strain")
    assert shown > before + 60, (before, shown)
    assert room().found_of(target).wrong.tolist() == [WRONG]
    with bpy.context.temp_override(**harness.view(), active_object=target):
        bpy.ops.ed.undo_push(message="Strain")
        bpy.ops.ed.undo()
    yield 1.0
    assert blue("strain_undone") <= before + 5


harness.run_in_window(globals())
