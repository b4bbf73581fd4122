# SPDX-License-Identifier: GPL-3.0-or-later
"""How long Live takes for a moved vertex, part by part: the add-on in Blender as a Python module,
in Edit Mode.

What Blender does to draw the surface comes on top; tests/blender/window_live.py prints updates in a
window.
"""

import sys
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import table

ROOT = Path(__file__).resolve().parent.parent
MOVES = 24
MESHES = ("torus", "monkey")
ENERGIES = ("THIN_PLATE", "TOTAL_CURVATURE", "MINIMUM_VARIATION")
PARTS = ("read", "build", "solve", "write")


def run() -> dict[str, Any]:
    """The middle of each part over the moves of one vertex, milliseconds."""
    sys.path.insert(0, str(ROOT))
    try:
        import bpy
    except ImportError:
        print("live: Blender as a Python module is not there")
        return {}
    import addon

    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon.register()
    try:
        result = {
            f"{mesh}, {energy}": _measure(mesh, energy) for mesh in MESHES for energy in ENERGIES
        }
    finally:
        addon.unregister()
    rows = [
        [name, r["triangles"], *(r[part] for part in PARTS), r["graph"], r["whole"], r["worst"]]
        for name, r in result.items()
    ]
    heads = ["mesh", "triangles", *PARTS, "dependency graph", "whole", "worst"]
    table.show("Live: milliseconds of one update", heads, rows)
    return result


def _measure(mesh: str, energy: str) -> dict[str, float]:
    import bmesh
    import bpy

    from addon.live import registry

    source = _add(mesh)
    bpy.context.scene.discrete_fairing.energy = energy
    bpy.ops.object.fairing_live(state="ON")
    session = registry.sessions()[0]
    bpy.ops.object.mode_set(mode="EDIT")
    edit = bmesh.from_edit_mesh(source.data)
    edit.verts.ensure_lookup_table()
    vertex = edit.verts[0]
    updates = []
    for _ in range(MOVES):
        vertex.co += 0.01 * vertex.normal
        bmesh.update_edit_mesh(source.data, loop_triangles=False, destructive=False)
        start = perf_counter()
        bpy.context.view_layer.update()
        whole = 1e3 * (perf_counter() - start)
        updates.append(
            dict(session.parts) | {"whole": whole, "graph": whole - sum(session.parts.values())}
        )
    bpy.ops.object.mode_set(mode="OBJECT")
    registry.remove(session)
    warm = updates[2:]
    middle = {name: median(update[name] for update in warm) for name in warm[0]}
    return middle | {
        "triangles": session.triangles,
        "worst": max(update["whole"] for update in warm),
    }


def _add(mesh: str) -> Any:
    import bpy

    if mesh == "monkey":
        bpy.ops.mesh.primitive_monkey_add()
    else:
        bpy.ops.mesh.primitive_torus_add(major_segments=24, minor_segments=16)
    return bpy.context.active_object
