# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare in a real window: three surfaces in a row, with their names and figures."""

import importlib
import sys
from pathlib import Path
from time import perf_counter

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness

PATIENCE = 300.0  # seconds


def test_one_click_puts_the_energies_side_by_side():
    running = importlib.import_module(f"{harness.EXTENSION}.queue").running
    harness.add_suzanne()
    bpy.context.scene.discrete_fairing.levels = 2
    yield from harness.unfold_panels("VIEW3D_PT_fairing_inspect", "VIEW3D_PT_fairing_compare")
    with bpy.context.temp_override(**harness.view()):
        assert bpy.ops.object.fairing_compare("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    begun = perf_counter()
    while running():
        assert perf_counter() - begun < PATIENCE, "the run does not end"
        yield 0.2
    names = ["Suzanne Bending", "Suzanne Curvature", "Suzanne Flow Lines"]
    places = [bpy.data.objects[name].location.x for name in names]
    assert 0.0 < places[0] < places[1] < places[2]
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.fairing_show_source()
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_all()
    yield 1.0
    yield from harness.show_the_end_of_the_sidebar()
    harness.photograph("compare")


harness.run_in_window(globals())
