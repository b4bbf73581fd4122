# SPDX-License-Identifier: GPL-3.0-or-later
"""Two hundred runs in one process: memory stays where it is, and no mesh ever needs mending."""

import ctypes
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness

RUNS = 200
# Runs in which memory is compared. Before the first 40 are over, caches fill. The least of many runs
# is what a leak would raise.
WINDOW = 40
ALLOWED = 1.01


def resident_bytes():
    """Memory of this process that is in use, without what the allocator keeps in reserve: that comes
    and goes by megabytes.
    """
    ctypes.CDLL(None).malloc_trim(0)
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


def assert_steady(memory, what):
    """`memory` in bytes after each run: no more in the last WINDOW runs than when it had settled."""
    settled, end = min(memory[WINDOW : 2 * WINDOW]), min(memory[-WINDOW:])
    print(
        f"memory in {what} {WINDOW} to {2 * WINDOW} {settled / 2**20:.1f} MB, "
        f"in the last {WINDOW} {end / 2**20:.1f} MB"
    )
    assert end <= ALLOWED * settled, f"{end / settled - 1:.1%} more memory"


def once(source, **settings):
    """Fairs `source`, checks the mesh, and removes the result again."""
    bpy.context.view_layer.objects.active = source
    source.select_set(True)
    assert bpy.ops.object.fairing_surface(levels=2, hide_source=False, **settings) == {"FINISHED"}
    result = bpy.context.active_object
    assert result != source and not result.data.validate(verbose=True), (
        "validate() had to mend the mesh"
    )
    mesh = result.data
    bpy.data.objects.remove(result)
    bpy.data.meshes.remove(mesh)


def test_two_hundred_runs():
    bpy.ops.mesh.primitive_monkey_add()
    source = bpy.context.active_object
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Smile")
    source.vertex_groups.new(name="Skull").add(range(100), 0.5, "REPLACE")
    memory = []
    for run in range(RUNS):
        once(source, interpolation="APPROXIMATE" if run % 4 == 3 else "EXACT", tolerance=0.01)
        memory.append(resident_bytes())
    assert_steady(memory, "runs")


def test_two_hundred_recomputations():
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.fairing_surface(levels=2)
    result = bpy.context.active_object
    memory = []
    for _ in range(RUNS):
        assert bpy.ops.object.fairing_recompute() == {"FINISHED"}
        assert bpy.context.active_object == result and not result.data.validate()
        memory.append(resident_bytes())
    assert_steady(memory, "recomputations")
    assert len(bpy.data.meshes) == 2


harness.run(globals())
