# SPDX-License-Identifier: GPL-3.0-or-later
"""Export to CAD in a real window: the file browser, the progress, ESC, several objects, a refusal."""

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness

FOLDER = tempfile.mkdtemp()


def alone(*targets):
    """These objects are all that is left, and selected; seen whole."""
    for other in list(bpy.data.objects):
        if other not in targets:
            bpy.data.objects.remove(other)
    for target in targets:
        target.select_set(True)
    bpy.context.view_layer.objects.active = targets[0]
    harness.call(bpy.ops.view3d.view_selected)


def add_balls(*places):
    """A cube at each place, whose surface is a sphere."""
    bpy.context.scene.discrete_fairing.energy = "TOTAL_CURVATURE"
    found = []
    for x in places:
        bpy.ops.mesh.primitive_cube_add(location=(x, 0, 0))
        found.append(bpy.context.active_object)
        found[-1].name = f"Ball {len(found)}"
    alone(*found)
    return found


def browse(path, **settings):
    """Opens the file browser as the menu does, photographs it and presses Export; a generator."""
    harness.call(
        bpy.ops.export_scene.fairing_step, "INVOKE_DEFAULT", filepath=str(path), **settings
    )
    yield from harness.drawn(bpy.types.SpaceFileBrowser)
    harness.photograph("step_browser")
    yield from harness.execute_browser()
    yield 0.3


def parts(path):
    """Names of the parts of a STEP file."""
    lines = path.read_text(encoding="ascii").splitlines()
    assert lines[-1] == "END-ISO-10303-21;"
    return sorted(line.split("'")[1] for line in lines if "=PRODUCT('" in line)


def left_over(path):
    return [other.name for other in path.parent.iterdir() if other.name.startswith(f".{path.name}")]


def test_several_objects_by_the_file_browser():
    path = Path(FOLDER) / "balls.step"
    add_balls(0, 4)
    yield from harness.open_sidebar("Fairing")
    yield from browse(path, fit_levels=6)
    assert harness.running(), "a long run does not block"
    assert harness.running().position[1] == 2
    seen = yield from harness.until_it_ends()
    fractions = [fraction for fraction, _ in seen]
    assert fractions == sorted(fractions) and len(set(fractions)) > 2
    assert parts(path) == ["Ball 1", "Ball 2"] and not left_over(path)
    harness.photograph("step_written")


def test_the_button_and_the_patches_of_a_surface():
    add_balls(0)
    harness.call(bpy.ops.object.fairing_surface, levels=3, energy="TOTAL_CURVATURE")
    yield from harness.open_sidebar("Fairing")
    harness.photograph("step_button")
    harness.call(bpy.ops.object.fairing_show_patches, "INVOKE_DEFAULT")
    yield from harness.until_it_ends()
    patches = bpy.context.view_layer.objects.active
    assert patches.type == "SURFACE" and len(patches.data.splines) == 6
    bpy.data.objects["Ball 1 Fair"].hide_set(True)
    yield 1.0
    harness.photograph("step_patches")


harness.run_in_window(globals())
