# SPDX-License-Identifier: GPL-3.0-or-later
"""Which vertices are each other's mirror images, in the control mesh and through its lattices in the refined one.

Nothing is matched by nearness: control vertices have to lie exactly opposite, and the rest follows from the faces.
"""

from dataclasses import dataclass

import numpy as np

from .lattice import pair_keys

AXES = "XYZ"
NONE, SEVERAL = -1, -2  # for images of vertices that belong to no face, or that are not known yet


@dataclass(frozen=True)
class Mirror:
    """A plane through the origin across which a control mesh is its own mirror image."""

    axis: int  # 0, 1 or 2: the coordinate that changes its sign
    control: np.ndarray  # (n,) int32: the image of each control vertex, NONE for those without a face
    fine: np.ndarray  # (N,) int32: the same for the refined vertices


def opposite(positions, axis, used):
    """(n,) int32: the vertex exactly opposite to each of `positions` (n, 3), NONE for those that are not `used` (n,) bool.

    SEVERAL for vertices that share their place with others. None if a vertex has no opposite at all.
    """
    ids = np.flatnonzero(used)
    points = positions[ids]
    image = points.copy()
    image[:, axis] *= -1.0
    order, image_order = np.lexsort(points.T), np.lexsort(image.T)
    in_order = points[order]
    if not np.array_equal(in_order, image[image_order]):
        return None
    same = (in_order[1:] == in_order[:-1]).all(axis=1)
    several = np.append(same, False) | np.append(False, same)[: len(ids)]
    found = np.full(len(positions), NONE, np.int32)
    found[ids[image_order]] = np.where(several, SEVERAL, ids[order])
    return found


def refined_mirror(patches, opposites, axis, vertex_count):
    """The Mirror of a control mesh whose vertices have the images `opposites` (n,); None if its faces are not symmetric.

    `patches`: the Patches that its faces were refined to; `vertex_count`: refined vertices.
    """
    opposites = _tell_apart(patches, opposites)
    if (opposites == SEVERAL).any():
        return None
    control = np.full(vertex_count, NONE, np.int32)  # vertices and centres of fans
    control[: len(opposites)] = opposites
    fine = control.copy()
    for patch in patches:
        vertices = patch.faces.vertices
        found, face, turn = _image_faces(vertices, opposites, side=0)  # which never ends at a centre
        if len(found) < len(vertices):
            return None
        image = _corner_images(vertices, face, turn)
        centre = vertices[:, -1] >= len(opposites)
        control[vertices[centre, -1]] = image[centre, -1]
        if not np.array_equal(control[vertices], image):
            return None
        _spread(patch, face, turn, fine)
    return Mirror(axis, opposites, fine)


def maps_pairs(mirror, pairs):
    """Whether the vertex `pairs` (k, 2) are a symmetric set."""
    pairs = np.asarray(pairs, np.int64).reshape(-1, 2)
    image = mirror.control[pairs]
    return (image >= 0).all() and np.array_equal(np.unique(pair_keys(pairs)), np.unique(pair_keys(image)))


def maps_vertices(mirror, vertices):
    """Whether the `vertices` (k,) are a symmetric set."""
    return np.array_equal(np.unique(vertices), np.unique(mirror.control[np.asarray(vertices, np.int64)]))


def maps_positions(mirror, positions):
    """Whether `positions` (n, 3), of the control vertices, lie exactly opposite each other."""
    used = mirror.control >= 0
    image = positions[mirror.control[used]]
    image[:, mirror.axis] *= -1.0
    return np.array_equal(positions[used], image)


def _tell_apart(patches, opposites):
    """`opposites` with as many SEVERAL as possible replaced: faces next to a side whose image is known give the others."""
    opposites = opposites.copy()
    unknown = np.count_nonzero(opposites == SEVERAL)
    while unknown:
        for patch in patches:
            vertices = patch.faces.vertices
            for side in range(patch.faces.size):
                found, face, turn = _image_faces(vertices, opposites, side)
                corners, image = vertices[found], _corner_images(vertices, face, turn)
                own = (corners < len(opposites)) & (image < len(opposites))
                own[own] = opposites[corners[own]] == SEVERAL
                opposites[corners[own]] = image[own]
        left = np.count_nonzero(opposites == SEVERAL)
        if left == unknown:
            break
        unknown = left
    return opposites


def _image_faces(vertices, opposites, side):
    """The image of each face by its given side: (ids of faces that have one, image face, turn), each (f,).

    A mirrored face runs the other way round: its side a → b has its image in a side b' → a'. So corner i of a face has
    its image at corner (turn - i) mod k of the image face.
    """
    size = vertices.shape[1]
    known = np.append(opposites, np.full(int(vertices.max()) + 1, NONE, np.int32))  # centres have none yet
    keys = (vertices.astype(np.int64) << 32 | np.roll(vertices, -1, axis=1)).ravel()
    start, end = known[vertices[:, (side + 1) % size]], known[vertices[:, side]]
    wanted = np.where((start >= 0) & (end >= 0), start.astype(np.int64) << 32 | end, -1)
    order = np.argsort(keys)
    place = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)]
    found = np.flatnonzero(keys[place] == wanted)
    face, image_side = np.divmod(place[found], size)
    return found, face, image_side + 1 + side


def _corner_images(vertices, face, turn):
    """(F, k) int32: the vertex that is the image of each corner."""
    size = vertices.shape[1]
    return vertices[face[:, None], (turn[:, None] - np.arange(size)) % size]


def _spread(patch, face, turn, fine):
    """Writes the images of all lattice points of the faces in `patch`."""
    ids = patch.fine.reshape(len(face), -1)[:, patch.cells.first_corner]
    size = patch.faces.size
    for t in range(size):
        chosen = turn % size == t
        fine[ids[chosen]] = ids[face[chosen]][:, _turned_points(patch.cells, t)]


def _turned_points(cells, turn):
    """(P,) int32: where each point goes when corner i goes to corner (turn - i) mod k."""
    size = cells.weights.shape[1]
    weights = cells.weights[:, (turn - np.arange(size)) % size]
    order, turned_order = np.lexsort(cells.weights.T), np.lexsort(weights.T)
    found = np.empty(len(weights), np.int32)
    found[turned_order] = order
    return found
