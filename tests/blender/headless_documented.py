# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls that the documents show, as they stand there, in this Blender and its Python."""

import os
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness

DOCS = Path(__file__).resolve().parents[1] / "docs"  # copied beside the scripts
PURPOSES = ("HULL", "PANEL", "MECHANICAL", "CHARACTER", "SCAN_PATCH", "POINTS")
OPERATOR = re.compile(r"\b(?:bpy\.ops\.)?(object|export_scene)\.(fairing_\w+)")


def scan():
    """Noisy enough for each purpose."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
    source = bpy.context.object
    for vertex in source.data.vertices:
        vertex.co *= 1.0 + 0.004 * ((7 * vertex.index) % 5 - 2)
    source.data.update()
    return source


def test_fair_for_every_purpose():
    for purpose in PURPOSES:
        harness.fresh_scene()
        source = scan()
        faces = len(source.data.polygons)
        bpy.context.scene.discrete_fairing.levels = 1
        assert bpy.ops.object.fairing_for(purpose=purpose) == {"FINISHED"}, purpose
        made = bpy.context.active_object
        assert (made == source) == (purpose == "SCAN_PATCH")
        assert len(made.data.polygons) >= faces


def test_operators_are_there():
    named = {
        pair for page in DOCS.rglob("*.md") for pair in OPERATOR.findall(page.read_text("utf-8"))
    }
    assert len(named) > 10
    assert [pair for pair in named if pair[1] not in dir(getattr(bpy.ops, pair[0]))] == []


def test_the_page_on_scripts():
    blocks = re.findall(
        r"^```python\n(.*?)^```", (DOCS / "how-to" / "scripting.md").read_text("utf-8"), re.M | re.S
    )
    assert len(blocks) > 5
    before, namespace = Path.cwd(), {}
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        os.environ["PWD"] = folder
        try:
            for number, block in enumerate(blocks, 1):
                exec(compile(block, f"scripting.md, example {number}", "exec"), namespace)
        finally:
            os.chdir(before)


harness.run(globals())
