# SPDX-License-Identifier: GPL-3.0-or-later
"""Two hundred runs in one process: memory does not grow, and no mesh needs mending."""

import ctypes
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import discrete_fairing
import harness
import numpy as np

RUNS = 200
# Memory is compared over so many runs, after caches have filled in the first ones. A leak would raise
# the least value of many runs.
WINDOW = 40
# Bytes that a run may leave behind, on average: Python's own tables grow a little. One array of
# Suzanne's vertices is 12 KB.
LEFT = 1024


class Heap(ctypes.Structure):
    """`struct mallinfo2` of the C library."""

    _fields_ = [
        ("arena", ctypes.c_size_t),
        ("ordblks", ctypes.c_size_t),
        ("smblks", ctypes.c_size_t),
        ("hblks", ctypes.c_size_t),
        ("hblkhd", ctypes.c_size_t),
        ("usmblks", ctypes.c_size_t),
        ("fsmblks", ctypes.c_size_t),
        ("uordblks", ctypes.c_size_t),
        ("fordblks", ctypes.c_size_t),
        ("keepcost", ctypes.c_size_t),
    ]


def bytes_in_use():
    """Bytes allocated and not freed, by the allocator in build_tools; resident memory jumps."""
    mallinfo2 = ctypes.CDLL("libc.so.6").mallinfo2
    mallinfo2.restype = Heap
    heap = mallinfo2()
    return heap.uordblks + heap.hblkhd


def assert_steady(memory, what):
    """`memory` in bytes after each run: the last WINDOW runs use no more than the runs after it had settled."""
    settled, end = min(memory[WINDOW : 2 * WINDOW]), min(memory[-WINDOW:])
    left = (end - settled) / (len(memory) - 2 * WINDOW)
    print(f"{what}: {settled / 2**20:.2f} MB, then {end / 2**20:.2f} MB: {left:.0f} bytes a run")
    assert left <= LEFT, f"each of {what} leaves {left:.0f} bytes behind"


def once(source, **settings):
    """Fairs `source`, checks the mesh, and removes the result again."""
    bpy.context.view_layer.objects.active = source
    source.select_set(True)
    assert bpy.ops.object.fairing_surface(hide_source=False, **settings) == {"FINISHED"}
    result = bpy.context.active_object
    assert result != source and not result.data.validate(verbose=True), (
        "validate() had to mend the mesh"
    )
    mesh = result.data
    bpy.data.objects.remove(result)
    bpy.data.meshes.remove(mesh)


def level_of(run):
    """Mostly 1, since a leak does not depend on size; 2 has a level between the first and last."""
    return 2 if run % 9 == 0 else 1


def a_mesh():
    mesh = bpy.data.meshes.new("Left behind")
    mesh.vertices.add(10000)
    return mesh


def an_array():
    return np.ones((10000, 3))


def a_surface():
    cube = np.array([[x, y, z] for x in (-1.0, 1) for y in (-1.0, 1) for z in (-1.0, 1)])
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return discrete_fairing.Solver(cube, faces, levels=5)


def test_what_is_left_behind_is_seen():
    """Blender, NumPy and the native module may use different allocators; each is counted."""
    for make in (a_mesh, an_array, a_surface):
        before = bytes_in_use()
        kept = make()
        assert bytes_in_use() - before > 100_000, f"{make.__name__} is not counted"
        del kept


def test_two_hundred_runs():
    bpy.ops.mesh.primitive_monkey_add()
    source = bpy.context.active_object
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Smile")
    source.vertex_groups.new(name="Skull").add(range(100), 0.5, "REPLACE")
    memory = []
    for run in range(RUNS):
        interpolation = "APPROXIMATE" if run % 4 == 3 else "EXACT"
        once(source, levels=level_of(run), interpolation=interpolation, tolerance=0.01)
        memory.append(bytes_in_use())
    assert_steady(memory, "runs")


def test_two_hundred_recomputations():
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.fairing_surface(levels=2)
    result = bpy.context.active_object
    memory = []
    for run in range(RUNS):
        result.discrete_fairing.levels = level_of(run)
        assert bpy.ops.object.fairing_recompute() == {"FINISHED"}
        assert bpy.context.active_object == result and not result.data.validate()
        memory.append(bytes_in_use())
    assert_steady(memory, "recomputations")
    assert len(bpy.data.meshes) == 2


harness.run(globals())
