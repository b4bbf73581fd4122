# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygon meshes as triangles and edges for measuring: plain arrays, no Blender, no loop over faces.

`arrays` is anything with the fields of read.mesh.ControlArrays: positions (n, 3) float64, edges (e, 2), corners (c,),
corner_edges (c,), offsets (m + 1,) integers, sharp_edge (e,) bool or None.
"""

import numpy as np


def triangulate(positions, corners, offsets):
    """((t, 3) int32 triangles, (t,) float64 weights). Polygons under 3 corners are left out, large ones become fans.

    A quad is halved along its shorter diagonal; where both are about as long, it gives both halvings, weighted. Else
    curvature would hang on the order of the corners, lose the mesh's symmetry, and converge a whole order slower.
    """
    sizes, first = np.diff(offsets), offsets[:-1]
    plain = corners[first[sizes == 3, None] + np.arange(3)]
    large = sizes > 4
    fans = _fans(corners, first[large], sizes[large])
    halves, weights = _halve(positions, corners[first[sizes == 4, None] + np.arange(4)])
    triangles = np.concatenate([plain, fans, halves]).astype(np.int32, copy=False)
    return triangles, np.concatenate([np.ones(len(plain) + len(fans)), weights])


def uses(arrays):
    """(e,) how many faces each edge has."""
    return np.bincount(arrays.corner_edges, minlength=len(arrays.edges))


def rim_edges(arrays):
    """(e,) bool: edges where the surface stops being one smooth piece: borders, three faces and more, marked sharp."""
    count = uses(arrays)
    rim = (count == 1) | (count > 2)
    return rim if arrays.sharp_edge is None else rim | arrays.sharp_edge


def marked_vertices(edges, marked, count):
    """(count,) bool: vertices at the ends of the `marked` edges."""
    vertices = np.zeros(count, bool)
    vertices[edges[marked].ravel()] = True
    return vertices


def faces_of_edges(arrays):
    """(e, 2) int32: the two faces of each edge. Only meaningful where `uses` is 2."""
    sizes = np.diff(arrays.offsets)
    face = np.repeat(np.arange(len(sizes), dtype=np.int32), sizes)
    pair = np.zeros((len(arrays.edges), 2), np.int32)
    pair[arrays.corner_edges, 1] = face  # the last one written stays
    pair[arrays.corner_edges[::-1], 0] = face[::-1]
    return pair


def face_normals(positions, corners, offsets):
    """(m, 3) unit normals by Newell's sum, which for a quad is that of its diagonals; zero for faces without area."""
    normals = np.zeros((len(offsets) - 1, 3))
    if not len(corners):
        return normals
    sizes = np.diff(offsets)
    following = np.arange(1, len(corners) + 1, dtype=np.int32)
    following[offsets[1:][sizes > 0] - 1] = offsets[:-1][sizes > 0]
    # about the first corner of each face: far from the origin the sum would lose its digits
    local = positions[corners] - np.repeat(
        positions[corners[offsets[:-1][sizes > 0]]], sizes[sizes > 0], axis=0
    )
    turned = cross(local, local[following])
    for axis in range(3):
        normals[sizes > 0, axis] = np.add.reduceat(turned[:, axis], offsets[:-1][sizes > 0])
    return unit(normals)


def cross(a, b):
    """Row by row; several times as fast as np.cross."""
    out = np.empty_like(a)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        out[:, i] = a[:, j] * b[:, k] - a[:, k] * b[:, j]
    return out


def unit(vectors):
    """Rows of length 1; zero rows stay zero."""
    length = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
    return vectors / np.where(length > 0, length, 1.0)[:, None]


def _halve(positions, quads):
    """Triangles (t, 3) and weights (t,) of (q, 4) quads. The halving that is not inside a quad with a dent has no weight."""
    a, b, c, d = (positions[quads[:, i]] for i in range(4))
    ac, bd = c - a, d - b
    normal = cross(ac, bd)
    inside_ac = _both_face(normal, cross(b - a, ac), cross(ac, d - a))
    inside_bd = _both_face(normal, cross(b - a, d - a), cross(c - b, bd))
    square_ac, square_bd = np.einsum("ij,ij->i", ac, ac), np.einsum("ij,ij->i", bd, bd)
    share = square_bd / np.maximum(square_ac + square_bd, np.finfo(float).tiny)
    weight = np.clip(
        0.5 + 5.0 * (share - 0.5), 0.0, 1.0
    )  # of ac: from 0 to 1 while the lengths change places
    weight = np.where(inside_ac == inside_bd, weight, inside_ac)
    along_ac, along_bd = weight > 0.0, weight < 1.0
    triangles = [quads[along_ac][:, half] for half in ([0, 1, 2], [0, 2, 3])]
    triangles += [quads[along_bd][:, half] for half in ([0, 1, 3], [1, 2, 3])]
    weights = [weight[along_ac]] * 2 + [1.0 - weight[along_bd]] * 2
    return np.concatenate(triangles), np.concatenate(weights)


def _both_face(normal, first, second):
    return (np.einsum("ij,ij->i", normal, first) > 0.0) & (np.einsum("ij,ij->i", normal, second) > 0.0)


def _fans(corners, first, sizes):
    each = sizes - 2
    start = np.repeat(first, each)
    step = np.arange(each.sum()) - np.repeat(np.cumsum(each) - each, each)
    return np.stack([corners[start], corners[start + step + 1], corners[start + step + 2]], axis=1)
