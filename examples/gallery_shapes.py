# SPDX-License-Identifier: GPL-3.0-or-later
"""The shapes of the gallery, and their sources."""

from collections.abc import Callable
from dataclasses import dataclass
from math import radians

import bpy
import demo_meshes
import numpy as np
from demo_meshes import ControlMesh


class Absent(Exception):
    """Raised if the mesh is absent on this machine."""


@dataclass(frozen=True)
class View:
    turn: float = 0.0  # degrees about the vertical
    elevation: float = 17.0  # degrees, of the camera
    stripes: int = 7
    contrast: float = (
        1.25  # the end of the colours over the 90th percentile of total curvature's surface
    )
    dots: bool = False  # on the control vertices


@dataclass(frozen=True)
class Shape:
    make: Callable[[object], ControlMesh]
    levels: int
    view: View


def tetrahedron(_folder):
    """The solid on the unit sphere, with one face down."""
    angle = 2 * np.pi * np.arange(3) / 3
    low = np.stack([8**0.5 / 3 * np.cos(angle), 8**0.5 / 3 * np.sin(angle), np.full(3, -1 / 3)], -1)
    points = np.concatenate([low, [[0, 0, 1]]])
    return ControlMesh(points, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])


def octahedron(_folder):
    """The solid on the unit sphere, with one corner up."""
    points = np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    ring = [(k, (k + 1) % 4) for k in range(4)]
    return ControlMesh(points, [(a, b, 4) for a, b in ring] + [(b, a, 5) for a, b in ring])


def torus(_folder, around=8, across=6):
    """The Clifford torus, which bends least of all tori."""
    a, b = np.meshgrid(
        2 * np.pi * np.arange(around) / around,
        2 * np.pi * np.arange(across) / across,
        indexing="ij",
    )
    ring = 2**0.5 + np.cos(b)
    points = np.stack([ring * np.cos(a), ring * np.sin(a), np.sin(b)], -1).reshape(-1, 3)
    faces = []
    for u in range(around):
        for v in range(across):
            right, up = (u + 1) % around, (v + 1) % across
            faces.append((u * across + v, right * across + v, right * across + up, u * across + up))
    return ControlMesh(points, faces)


def suzanne(_folder):
    """Blender's monkey."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_monkey_add()
    mesh = bpy.context.active_object.data
    return ControlMesh(
        np.array([v.co for v in mesh.vertices], float), [tuple(p.vertices) for p in mesh.polygons]
    )


def from_file(name):
    """An OBJ or PLY with its y axis up."""

    def make(folder):
        paths = sorted(folder.rglob(f"*{name}")) if folder else []
        if not paths:
            raise Absent(f"{name} is not here (--meshes FOLDER)")
        points, faces = (_ply if name.endswith(".ply") else _obj)(paths[0])
        return ControlMesh(np.array([(x, -z, y) for x, y, z in points]), faces)

    return make


def _obj(path):
    """Positions and polygons as they are stored."""
    points, faces = [], []
    for words in (line.split() for line in path.read_text().splitlines()):
        if words[:1] == ["v"]:
            points.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["f"]:
            faces.append(tuple(int(word.split("/")[0]) - 1 for word in words[1:]))
    return points, faces


def _ply(path):
    """The same mesh, read by Blender."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.wm.ply_import(filepath=str(path))  # leaves the axes alone
    mesh = bpy.context.active_object.data
    return [tuple(v.co) for v in mesh.vertices], [tuple(p.vertices) for p in mesh.polygons]


def tipped(make, degrees):
    """The mesh turned about the x axis."""

    def made(folder):
        mesh = make(folder)
        c, s = np.cos(radians(degrees)), np.sin(radians(degrees))
        turn = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
        return ControlMesh(mesh.vertices @ turn.T, mesh.faces, mesh.crease_edges)

    return made


SHAPES = {
    "tetrahedron": Shape(tetrahedron, 6, View(turn=-65, contrast=2, dots=True)),
    "octahedron": Shape(octahedron, 5, View(turn=-65, contrast=2, dots=True)),
    "torus": Shape(torus, 4, View(turn=10, elevation=38, stripes=6)),
    "suzanne": Shape(suzanne, 3, View(turn=24, stripes=3)),
    "hull": Shape(
        tipped(lambda _folder: demo_meshes.hull(), -30),
        4,
        View(turn=-65, stripes=12, contrast=1),
    ),
    "bob": Shape(from_file("bob_small.ply"), 3, View(turn=150, elevation=25, stripes=5)),
    "cat_head": Shape(from_file("cat_head.obj"), 3, View(turn=20, stripes=5)),
    "hand": Shape(from_file("hand_lowres.obj"), 2, View(turn=0, stripes=5)),
    "spot": Shape(from_file("spot_control_mesh.obj"), 3, View(turn=135, stripes=3)),
    "fish": Shape(from_file("fish_control_mesh.obj"), 4, View(turn=-60, stripes=5)),
}
