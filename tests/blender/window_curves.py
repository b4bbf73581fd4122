# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Surface from Curves in a window, from defaults: a crossing, a hull, a bonnet; a handle that Live follows."""

import importlib
import sys
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[1] / "examples"))

import bpy
import curve_networks
import harness
import jobs
import numpy as np


def clear():
    for other in list(bpy.data.objects):
        bpy.data.objects.remove(other)


def drawn(network):
    return [jobs.bezier(*curve) for curve in network()]


crossing, bonnet, hull, star = (
    partial(drawn, getattr(curve_networks, name)) for name in ("crossing", "bonnet", "hull", "star")
)
crown = curve_networks.crown


def waited():
    while importlib.import_module(f"{harness.EXTENSION}.queue").running():
        yield 0.2
    yield 1.0


def one_click(name, make):
    """A generator that returns the surface: all curves selected, one call from the menu, stripes."""
    with bpy.context.temp_override(**harness.view()):
        clear()
        curves = make()
        for curve in curves:
            curve.select_set(True)
        bpy.context.view_layer.objects.active = curves[0]
        bpy.ops.view3d.view_selected()
    yield from harness.open_sidebar("Fairing")
    harness.photograph(f"curves_{name}_before")
    with bpy.context.temp_override(**harness.view()):
        answer = bpy.ops.object.fairing_curves("INVOKE_DEFAULT")
    assert answer <= {"FINISHED", "RUNNING_MODAL"}, answer
    yield from waited()
    surface = bpy.context.view_layer.objects.active
    assert surface.discrete_fairing.source.discrete_fairing_curves.curves[0].source in curves
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.fairing_inspect(mode="ZEBRA")
    yield 1.0
    harness.photograph(f"curves_{name}")
    return surface


def height(surface):
    """The largest around the middle, where the handle is."""
    points = np.array([vertex.co for vertex in surface.data.vertices])
    return points[np.hypot(points[:, 0], points[:, 1]) < 0.2, 2].max()


def test_a_crossing_and_a_handle():
    surface = yield from one_click("crossing", crossing)
    assert len(surface.data.polygons) == 64 * len(surface.discrete_fairing.source.data.polygons)
    surface.discrete_fairing_live.on = True
    yield 1.0
    before = height(surface)
    point = bpy.data.objects["Row 1"].data.splines[0].bezier_points[3]
    with bpy.context.temp_override(**harness.view()):
        for _ in range(5):
            for part in ("co", "handle_left", "handle_right"):
                getattr(point, part).z += 0.06
            bpy.data.objects["Row 1"].data.update_tag()
            yield 0.4
    yield 3.0
    harness.photograph("curves_live")
    assert height(surface) > before + 0.2, (before, height(surface))
    assert not surface.discrete_fairing_live.status.count("misses")


def test_a_hull():
    surface = yield from one_click("hull", hull)
    assert len(surface.data.polygons) > 1000


def test_cells_of_five_sides():
    surface = yield from one_click("star", star)
    assert len(surface.data.polygons) > 1000


def test_a_bonnet_without_its_third_section():
    surface = yield from one_click("bonnet", bonnet)
    points = np.array([vertex.co for vertex in surface.data.vertices])
    assert np.abs(points[:, 2] - crown(points[:, 0], points[:, 1])).max() < 0.01


def test_a_loose_end_is_said():
    def loose():
        end = [(x, 0.4, crown(x, 0.4)) for x in np.linspace(-1.2, 0.1, 5)]
        return [*bonnet(), jobs.bezier("Loose", end)]

    surface = yield from one_click("loose", loose)
    remarks = surface.discrete_fairing.source.discrete_fairing_curves.remarks
    assert remarks.startswith("'Loose' ends loose at (0.1 m, 0.4 m"), remarks


def test_the_entry_in_the_menu_add():
    with bpy.context.temp_override(**harness.view()):
        clear()
        for curve in crossing():
            curve.select_set(True)
        region = harness.view()["region"]
        harness.xdotool("mousemove", region.x + region.width // 2, region.y + region.height // 2)
        bpy.ops.wm.call_menu(name="VIEW3D_MT_mesh_add")
    yield 1.5
    harness.photograph("curves_menu")
    harness.xdotool("key", "Escape")
    yield 0.5


harness.run_in_window(globals())
