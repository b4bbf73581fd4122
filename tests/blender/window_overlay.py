# SPDX-License-Identifier: GPL-3.0-or-later
"""Stripes, also in Edit Mode; section curves and combs over the viewport."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness
import numpy as np

COMPILED = 240.0  # seconds until shaders must be there


def pixels(name):
    """(n, n, 3) uint8 of the middle of the viewport, as X shows it."""
    picture = harness.pixels(name)
    height, width, _ = picture.shape
    side = min(width, height) // 2
    left, top = (width - side) // 2, (height - side) // 2
    return picture[top : top + side, left : left + side]


def changes(picture):
    """The largest number of changes from dark to light along a line from top to bottom."""
    grey = picture.astype(float).mean(axis=2)
    light = np.where(grey > 160, 1, np.where(grey < 70, 0, -1))
    counts = []
    for column in light.T[:: max(1, len(light) // 40)]:
        known = column[column >= 0]
        counts.append(int(np.count_nonzero(np.diff(known) > 0)))
    return max(counts)


def coloured(picture):
    """The number of pixels that are not grey: combs have a colour for each axis."""
    return int(np.count_nonzero(np.ptp(picture.astype(int), axis=2) > 80))


def inspect(target, mode):
    harness.call(bpy.ops.object.fairing_inspect, "INVOKE_DEFAULT", target=target, mode=mode)


def ball():
    target = harness.add_suzanne()
    bpy.data.objects.remove(target)
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.mesh.primitive_uv_sphere_add(radius=2, segments=32, ring_count=16)
        bpy.ops.view3d.view_selected()
        bpy.context.object.select_set(False)  # its outline and highlight are no stripes
        bpy.ops.ed.undo_push(message="A ball is there")
    return bpy.context.object


def shading():
    return harness.view()["area"].spaces.active.shading


def test_stripes_and_back():
    target = ball()
    yield 1.0
    assert shading().type == "SOLID"
    last = pixels("overlay_plain")
    plain = changes(last)
    for mode in ("ZEBRA", "LINES", "ISOPHOTES"):
        inspect(target, mode)
        assert shading().type == "MATERIAL", "Solid shows no material"
        last = yield from striped(f"overlay_{mode.lower()}", 5, last)
        assert changes(last) > plain, (mode, plain)
    inspect(target, "NONE")
    assert shading().type == "SOLID", "as it was"
    yield 1.0
    assert changes(pixels("overlay_off")) == plain


def striped(name, least, last=0):
    """The picture, once unlike `last` and with `least` changes along a line; a generator."""

    def there(_path):
        picture = pixels(name)
        return np.any(picture != last) and changes(picture) >= least

    yield from harness.photograph_until(name, there, COMPILED)
    return pixels(name)


def test_sections_and_combs():
    target = ball()
    yield 0.5
    settings = bpy.context.scene.discrete_fairing_inspection
    before = coloured(pixels("sections_before"))
    target.discrete_fairing_inspection.sections = True
    settings.section_axes = {"Y", "Z"}
    yield 1.0
    combs = coloured(pixels("sections")) - before
    assert combs > 500
    settings.show_combs = False
    yield 1.0
    assert coloured(pixels("sections_alone")) - before < combs / 4
    target.discrete_fairing_inspection.sections = False


harness.run_in_window(globals())
