# SPDX-License-Identifier: GPL-3.0-or-later
"""Inspect in a real window."""

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
    with bpy.context.temp_override(
        **harness.view(), active_object=source, selected_objects=[source]
    ):
        assert bpy.ops.object.fairing_surface(levels=3) == {"FINISHED"}
    result = bpy.data.objects["Suzanne Fair"]
    view = harness.view()
    with bpy.context.temp_override(
        **view, active_object=result, object=result, selected_objects=[result]
    ):
        assert bpy.ops.object.fairing_inspect(mode="ZEBRA") == {"FINISHED"}
        assert bpy.ops.object.fairing_viewport() == {"FINISHED"}
        assert bpy.ops.object.fairing_measure() == {"FINISHED"}
    yield from wait_for_shading("inspect", STRIPES)
    with bpy.context.temp_override(
        **view, active_object=result, object=result, selected_objects=[result]
    ):
        assert bpy.ops.object.fairing_inspect(mode="MEAN") == {"FINISHED"}
    yield 2.0
    harness.photograph("curvature")
    with bpy.context.temp_override(
        **view, active_object=result, object=result, selected_objects=[result]
    ):
        assert bpy.ops.object.fairing_inspect(mode="NONE") == {"FINISHED"}
    yield 0.5
    assert not result.modifiers


harness.run_in_window(globals())
