# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Selected Faces in Place in a window: the view lives meanwhile, ESC and Cancel end it, undo takes it back."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bmesh
import bpy
import harness
import numpy as np

SIZE = 100  # faces a side: a run of a second at least
MARGIN = 2  # rows at the border that are not selected


def positions(target):
    edited = bmesh.from_edit_mesh(target.data)
    return np.array([tuple(vertex.co) for vertex in edited.verts])


def noisy_grid():
    """In Edit Mode, all but its margin selected; a generator that returns it."""
    for other in list(bpy.data.objects):
        bpy.data.objects.remove(other)
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=SIZE, y_subdivisions=SIZE, size=4)
        target = bpy.context.object
        points = np.empty(3 * len(target.data.vertices), np.float32)
        target.data.vertices.foreach_get("co", points)
        points[2::3] = np.random.default_rng(0).uniform(-0.02, 0.02, len(points) // 3)
        target.data.vertices.foreach_set("co", points)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_mode(type="FACE")
        for face in bmesh.from_edit_mesh(target.data).faces:
            x, y, _ = face.calc_center_median()
            face.select_set(max(abs(x), abs(y)) < 2.0 - 4.0 * MARGIN / SIZE)
        bmesh.update_edit_mesh(target.data)
        bpy.ops.ed.undo_push(message="the grid is there")
    yield 1.0
    return target


def start(**options):
    return harness.call(bpy.ops.object.fairing_in_place, "INVOKE_DEFAULT", **options)


def test_a_long_run_leaves_the_window_alive_and_is_undone_in_one_step():
    target = yield from noisy_grid()
    before = positions(target)
    assert start() == {"RUNNING_MODAL"}
    yield 0.3
    harness.photograph("in_place_progress")
    seen = yield from harness.until_it_ends()
    assert len(seen) > 5, f"the window had {len(seen)} turns"
    after = positions(target)
    assert target.mode == "EDIT" and np.abs(after - before).max() > 0.01
    harness.undo()
    yield 0.5
    assert np.array_equal(positions(bpy.context.object), before)


harness.run_in_window(globals())
