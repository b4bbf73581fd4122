# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands in for a modifier, in a real window: the badge, Live that stays on in the file."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness


def surface(levels=2, **settings):
    """Suzanne and a surface of hers that is active, with the sidebar open; a generator."""
    source = harness.add_suzanne()
    yield from harness.open_sidebar("Fairing")
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.fairing_surface(levels=levels, **settings)
    yield 0.5
    return source, bpy.data.objects["Suzanne Fair"]


def test_a_badge_and_one_button_for_all():
    source, target = yield from surface()
    source.data.vertices[0].co.z += 1.0
    source.data.update()
    stale = harness.module("freshness").stale_surfaces
    yield from harness.until(lambda: list(stale()) == [target])
    yield 1.0
    harness.photograph("badge")
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.fairing_recompute_stale("INVOKE_DEFAULT")
    yield from harness.until(
        lambda: harness.module("queue").running() is None and not list(stale())
    )
    assert (target.data.vertices[0].co - source.data.vertices[0].co).length == 0.0


harness.run_in_window(globals())
