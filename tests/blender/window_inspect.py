# SPDX-License-Identifier: GPL-3.0-or-later
"""Inspect and Compare in a real window."""

import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness

STRIPES = 0.25  # contrast of black and white stripes; clay has less than a third of it
COMPILED = 120.0  # seconds until shaders must be there


def wait_for_shading(name, least):
    """Until the middle of the viewport has that much contrast: shaders take their time to compile. A generator."""
    region = harness.view()["region"]
    width, height = region.width, region.height
    crop = f"{width // 4}x{height // 3}+{width // 3}+{height // 3}"
    yield from harness.photograph_until(name, lambda path: contrast(path, crop) > least, COMPILED)


def contrast(path, crop):
    """Standard deviation of a part of a picture, 0 to 1, over all channels."""
    words = ["convert", path, "-crop", crop, "-format", "%[fx:standard_deviation]", "info:"]
    return float(
        subprocess.run(words, capture_output=True, check=True, text=True, timeout=60).stdout
    )


def test_zebra_and_curvature_are_seen():
    source = harness.add_suzanne()
    yield from harness.unfold_panels("VIEW3D_PT_fairing_inspect")
    operators, done = bpy.ops.object, {"FINISHED"}
    assert harness.call(operators.fairing_surface, target=source, levels=3) == done
    result = bpy.data.objects["Suzanne Fair"]
    assert harness.call(operators.fairing_inspect, target=result, mode="ZEBRA") == done
    assert harness.call(operators.fairing_viewport, target=result) == done
    assert harness.call(operators.fairing_measure, target=result) == done
    yield from wait_for_shading("inspect", STRIPES)
    assert harness.call(operators.fairing_inspect, target=result, mode="MEAN") == done
    yield 2.0
    harness.photograph("curvature")
    assert harness.call(operators.fairing_inspect, target=result, mode="NONE") == done
    yield 0.5
    assert not result.modifiers


def test_one_click_puts_the_energies_side_by_side():
    harness.add_suzanne()
    bpy.context.scene.discrete_fairing.levels = 2
    yield from harness.unfold_panels("VIEW3D_PT_fairing_inspect")
    assert harness.call(bpy.ops.object.fairing_compare, "INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield from harness.until_it_ends()
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
