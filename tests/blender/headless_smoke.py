# SPDX-License-Identifier: GPL-3.0-or-later
"""The installed extension without a window, with no modules but those of its zip."""

import importlib
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bmesh
import bpy
import harness
import numpy as np
from harness import EXTENSION

LEVELS = 2


def active_mesh_object(add, **arguments):
    """The object that a primitive operator makes."""
    add(**arguments)
    return bpy.context.active_object


def positions(mesh):
    """(n, 3) float32."""
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", flat)
    return flat.reshape(-1, 3)


def fair(source, **settings):
    """Runs the operator on one object and returns the new one."""
    assert bpy.ops.object.fairing_surface(levels=LEVELS, **settings) == {"FINISHED"}
    return bpy.data.objects[f"{source.name} Fair"]


def test_extension_brings_its_own_native_module():
    assert EXTENSION in bpy.context.preferences.addons
    native = importlib.import_module("discrete_fairing._native")
    assert "extensions" in native.__file__, native.__file__


def test_libraries_come_with_the_extension():
    lines = Path("/proc/self/maps").read_text().splitlines()
    loaded = {line.split()[-1] for line in lines if "OpenMesh" in line}
    native = Path(importlib.import_module("discrete_fairing._native").__file__)
    is_linked_in = b"libOpenMesh" not in native.read_bytes()  # as in wheels for every platform
    assert bool(loaded) != is_linked_in, loaded
    assert all("extensions" in path for path in loaded), loaded


def open_ball(subdivisions):
    """A triangulated sphere without its top."""
    ball = active_mesh_object(bpy.ops.mesh.primitive_ico_sphere_add, subdivisions=subdivisions)
    top = 1.0 - 0.64 / 4.0 ** (subdivisions - 4)
    bm = bmesh.new()
    bm.from_mesh(ball.data)
    gone = [face for face in bm.faces if face.calc_center_median().z > top]
    bmesh.ops.delete(bm, geom=gone, context="FACES")
    bm.to_mesh(ball.data)
    bm.free()
    return ball


def test_a_hole_in_a_large_mesh_is_filled():
    """To lengthen the arrays of a mesh of 10,000 vertices crashed Blender 5.2."""
    for subdivisions in (6, 8):  # 10,000 and 160,000 vertices
        ball = open_ball(subdivisions)
        faces = len(ball.data.polygons)
        assert bpy.ops.object.fairing_fill() == {"FINISHED"}
        mesh = ball.data
        assert len(mesh.polygons) > faces
        assert len(mesh.vertices) - len(mesh.edges) + len(mesh.polygons) == 2
        assert not mesh.validate()
        bpy.data.meshes.remove(mesh)


def sheet(name, first, last):
    """A bent sheet of 4 x 3 quads between two y."""
    x, y = np.meshgrid(np.linspace(0, 1.4, 5), np.linspace(first, last, 4), indexing="ij")
    points = np.stack([x, y, 0.3 - 0.2 * y * y + 0.1 * np.sin(2 * x)], axis=2).reshape(-1, 3)
    quads = [(k, k + 4, k + 5, k + 1) for k in range(16) if k % 4 < 3]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points.tolist(), [], quads)
    source = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(source)
    select(source)
    return fair(source)


def select(*objects):
    bpy.ops.object.select_all(action="DESELECT")
    for one in objects:
        one.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def normals_apart(one, other):
    """The largest length by which normals of two surfaces differ at vertices of both."""
    shown = []
    for surface in (one, other):
        normals = [tuple(normal.vector) for normal in surface.data.corner_normals]
        at = positions(surface.data).round(4)[[loop.vertex_index for loop in surface.data.loops]]
        shown.append(dict(zip(map(tuple, at.tolist()), normals)))
    common = shown[0].keys() & shown[1].keys()
    assert len(common) == 4 * 2**LEVELS + 1
    return max(np.linalg.norm(np.subtract(shown[0][at], shown[1][at])) for at in common)


def test_joined_surfaces_have_common_normals_until_they_are_free():
    panels = sheet("Bonnet", 0, 1.2), sheet("Fender", 1.2, 2)
    before = normals_apart(*panels)
    select(*panels)
    assert bpy.ops.object.fairing_match_border() == {"FINISHED"}
    assert before > 0.01 and normals_apart(*panels) < 0.001
    taker = next(panel for panel in panels if panel.discrete_fairing.neighbour)
    taker.discrete_fairing.neighbour = None
    select(taker)
    assert bpy.ops.object.fairing_recompute() == {"FINISHED"}
    assert normals_apart(*panels) > 0.01


def test_disable_and_enable_again():
    bpy.ops.preferences.addon_disable(module=EXTENSION)
    assert not hasattr(bpy.types, "OBJECT_OT_fairing_surface")
    bpy.ops.preferences.addon_enable(module=EXTENSION)
    assert hasattr(bpy.types, "OBJECT_OT_fairing_surface")


harness.run(globals())
