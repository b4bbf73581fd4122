# SPDX-License-Identifier: GPL-3.0-or-later
"""A lopsided box as a file of each kind, written by hand to test Blender's importers too."""

import os
from pathlib import Path

import numpy as np

# nothing is symmetric, so that a turned or mirrored axis shows
BOX = [
    (-1, -1, -1), (-1, -1, 1), (-1, 1, -1), (-1, 1, 1),
    (1, -1, -1), (1, -1, 1), (1, 1, -1), (1, 1, 1),
]  # fmt: skip
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
BOX_QUADS = len(FACES)


def box(offset=(0, 0, 0)):
    """(8, 3)."""
    return np.array(BOX, float) + offset


def lopsided():
    """A box with another length along each axis, away from the origin: (8, 3)."""
    return box() * (1.125, 0.75, 0.5) + (0.25, 3, -2)


def write_obj(name, names=("Box",), materials=(), shared=True):
    """One box an object, side by side; a material for each face in turn. Returns all vertices."""
    lines, points = [], []
    for number, own in enumerate(names):
        lines.append(f"o {own}")
        first = len(points)
        corners = box((4 * number, 0, 0))
        faces = FACES
        if not shared:
            corners, faces = corners[np.ravel(FACES)], np.arange(24).reshape(6, 4)
        lines += ["v {} {} {}".format(*point) for point in corners]
        points += corners.tolist()
        for index, face in enumerate(faces):
            if materials:
                lines.append(f"usemtl {materials[index % len(materials)]}")
            lines.append("f " + " ".join(str(first + corner + 1) for corner in face))
    Path(name).write_text("\n".join(lines) + "\n")
    return points


def write_faces(name, points, faces):
    """An OBJ of one object."""
    lines = ["v {} {} {}".format(*point) for point in points]
    lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in faces]
    Path(name).write_text("\n".join(["o Scan", *lines]) + "\n")


def write_ply(name, colours=None):
    """As text, with a colour (r, g, b), 0 to 255, for each vertex if given. Returns vertices."""
    points = lopsided()
    lines = ["ply", "format ascii 1.0", f"element vertex {len(points)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    if colours is not None:
        lines += [f"property uchar {name}" for name in ("red", "green", "blue")]
    lines += [f"element face {len(FACES)}", "property list uchar int vertex_indices", "end_header"]
    for index, point in enumerate(points):
        colour = () if colours is None else colours[index]
        lines.append(" ".join(map(str, (*point, *colour))))
    lines += [" ".join(map(str, (4, *face))) for face in FACES]
    Path(name).write_text("\n".join(lines) + "\n")
    return points


def write_stl(name):
    """As text, two triangles a face. Returns the vertices."""
    points = lopsided()
    lines = ["solid box"]
    for a, b, c, d in FACES:
        for triangle in ((a, b, c), (a, c, d)):
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += ["vertex {} {} {}".format(*points[corner]) for corner in triangle]
            lines += ["endloop", "endfacet"]
    Path(name).write_text("\n".join([*lines, "endsolid box"]) + "\n")
    return points


def read_obj(name):
    """Its vertices, (n, 3)."""
    lines = [line.split() for line in Path(name).read_bytes().splitlines()]
    return np.array([line[1:4] for line in lines if line[:1] == [b"v"]], float)


def materials_of(path):
    """The file of materials that an OBJ names."""
    lines = path.read_bytes().splitlines()
    (name,) = (line[7:] for line in lines if line.startswith(b"mtllib "))
    return path.parent / os.fsdecode(name)
