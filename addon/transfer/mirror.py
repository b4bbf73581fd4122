# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact symmetry: which vertices are each other's mirror images, and surfaces made as symmetric as
their control meshes.

Nothing is matched by nearness: control vertices have to lie exactly opposite, and the rest follows
from the faces through their lattices. Solvers round, and not alike on both sides: hence
`symmetrize`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core import ControlArrays
from .attributes import AttributeTransfer, Patch
from .lattice import Cells, pair_keys

AXES = "XYZ"
NONE, SEVERAL = -1, -2  # for images of vertices that belong to no face, or that are not known yet

_ROUNDING = 1e-4  # of the surface's size; more is no rounding: then something else is not symmetric


@dataclass(frozen=True)
class Mirror:
    """A plane through the origin across which a control mesh is its own mirror image."""

    axis: int  # 0, 1 or 2: the coordinate that changes its sign
    control: (
        np.ndarray
    )  # (n,) int32: the image of each control vertex, NONE for those without a face
    fine: np.ndarray  # (N,) int32: the same for the refined vertices


def opposite(positions: np.ndarray, axis: int, used: np.ndarray) -> np.ndarray | None:
    """(n,) int32: the vertex exactly opposite to each of `positions` (n, 3), NONE for those that
    are not `used` (n,) bool.

    SEVERAL for vertices that share their place with others. None if a vertex has no opposite at
    all.
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


def refined_mirror(
    patches: list[Patch], opposites: np.ndarray, axis: int, vertex_count: int
) -> Mirror | None:
    """The Mirror of a control mesh whose vertices have the images `opposites` (n,); None if its
    faces are not symmetric.

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
        found, face, turn = _image_faces(
            vertices, opposites, side=0
        )  # which never ends at a centre
        image = np.full_like(vertices, SEVERAL)
        image[found] = _corner_images(vertices, face, turn)
        flat = _in_the_plane(patch, opposites)
        image[flat] = vertices[flat]
        centre = vertices[:, -1] >= len(opposites)
        control[vertices[centre, -1]] = image[centre, -1]
        if not np.array_equal(control[vertices], image):
            return None
        _spread(patch, found, face, turn, fine)
        ids = patch.fine.reshape(len(vertices), -1)[flat].ravel()
        fine[ids] = ids
    return Mirror(axis, opposites, fine)


def maps_pairs(
    mirror: Mirror,
    pairs: np.ndarray | Sequence[Any],
    values: np.ndarray | Sequence[float] | float = 0.0,
) -> bool:
    """Whether the vertex `pairs` (k, 2) are a symmetric set, with their `values` (k,)."""
    pairs = np.asarray(pairs, np.int64).reshape(-1, 2)
    image = mirror.control[pairs]
    values = np.broadcast_to(values, len(pairs))
    own, first = np.unique(pair_keys(pairs), return_index=True)
    mirrored, first_mirrored = np.unique(pair_keys(image), return_index=True)
    return (
        bool((image >= 0).all())
        and np.array_equal(own, mirrored)
        and np.array_equal(values[first], values[first_mirrored])
    )


def maps_vertices(mirror: Mirror, vertices: np.ndarray | Sequence[Any]) -> bool:
    """Whether the `vertices` (k,) are a symmetric set."""
    return np.array_equal(
        np.unique(vertices), np.unique(mirror.control[np.asarray(vertices, np.int64)])
    )


def maps_positions(mirror: Mirror, positions: np.ndarray) -> bool:
    """Whether `positions` (n, 3), of the control vertices, lie exactly opposite each other."""
    used = mirror.control >= 0
    image = positions[mirror.control[used]]
    image[:, mirror.axis] *= -1.0
    return np.array_equal(positions[used], image)


def _tell_apart(patches: list[Patch], opposites: np.ndarray) -> np.ndarray:
    """`opposites` with as many SEVERAL as possible replaced: faces next to a side whose image is
    known give the others.
    """
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


def _image_faces(
    vertices: np.ndarray, opposites: np.ndarray, side: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The image of each face by its given side: (ids of faces that have one, image face, turn),
    each (f,).

    A mirrored face runs the other way round: its side a → b has its image in a side b' → a'. So
    corner i of a face has its image at corner (turn - i) mod k of the image face. Where sheets meet,
    several faces have such a side: there the corner beside it has to fit too.
    """
    size = vertices.shape[1]
    known = np.append(
        opposites, np.full(int(vertices.max()) + 1, NONE, np.int32)
    )  # centres have none yet
    keys = (vertices.astype(np.int64) << 32 | np.roll(vertices, -1, axis=1)).ravel()
    start, end = known[vertices[:, (side + 1) % size]], known[vertices[:, side]]
    wanted = np.where((start >= 0) & (end >= 0), start.astype(np.int64) << 32 | end, -1)
    if len(np.unique(keys)) < len(keys):
        beside = known[vertices[:, (side + 2) % size]]
        keys, wanted = _with_third(keys, np.roll(vertices, 1, axis=1).ravel(), wanted, beside)
    order = np.argsort(keys)
    place = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)]
    found = np.flatnonzero(keys[place] == wanted)
    face, image_side = np.divmod(place[found], size)
    return found, face, image_side + 1 + side


def _with_third(
    keys: np.ndarray, third: np.ndarray, wanted: np.ndarray, wanted_third: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """`keys` and `wanted` made one with a further vertex each; wanted ones without it become -1."""
    distinct, rank = np.unique(keys, return_inverse=True)
    place = np.minimum(np.searchsorted(distinct, wanted), len(distinct) - 1)
    there = (distinct[place] == wanted) & (wanted_third >= 0)
    return (
        rank.ravel().astype(np.int64) << 32 | third,
        np.where(there, place.astype(np.int64) << 32 | wanted_third, -1),
    )


def _corner_images(vertices: np.ndarray, face: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """(F, k) int32: the vertex that is the image of each corner."""
    size = vertices.shape[1]
    return vertices[face[:, None], (turn[:, None] - np.arange(size)) % size]


def _in_the_plane(patch: Patch, opposites: np.ndarray) -> np.ndarray:
    """(F,) bool: which faces are their own images, as a wall between two halves is: those of
    polygons whose vertices all lie in the plane.
    """
    vertices = patch.faces.vertices
    own = np.append(opposites, np.arange(len(opposites), vertices.max() + 1))[vertices] == vertices
    _, polygon = np.unique(patch.faces.polygon, return_inverse=True)
    outside = np.bincount(polygon.ravel(), ~own.all(axis=1))
    return outside[polygon.ravel()] == 0


def _spread(
    patch: Patch, found: np.ndarray, face: np.ndarray, turn: np.ndarray, fine: np.ndarray
) -> None:
    """Writes the images of all lattice points of the faces `found` in `patch`."""
    ids = patch.fine.reshape(len(patch.faces.vertices), -1)[:, patch.cells.first_corner]
    size = patch.faces.size
    for t in range(size):
        chosen = turn % size == t
        fine[ids[found[chosen]]] = ids[face[chosen]][:, _turned_points(patch.cells, t)]


def _turned_points(cells: Cells, turn: int) -> np.ndarray:
    """(P,) int32: where each point goes when corner i goes to corner (turn - i) mod k."""
    size = cells.weights.shape[1]
    weights = cells.weights[:, (turn - np.arange(size)) % size]
    order, turned_order = np.lexsort(cells.weights.T), np.lexsort(weights.T)
    found = np.empty(len(weights), np.int32)
    found[turned_order] = order
    return found


def find_mirrors(
    transfer: AttributeTransfer,
    arrays: ControlArrays,
    crease_edges: np.ndarray | Sequence[Any] = (),
    corner_vertices: np.ndarray | Sequence[Any] = (),
    soft_creases: tuple[Any, Any] = ((), ()),
) -> tuple[list[Mirror], list[str]]:
    """The planes x = 0, y = 0, z = 0 across which control mesh and features are symmetric: (list of
    Mirror, notes).

    `transfer`: AttributeTransfer; `arrays`: the control mesh; `crease_edges` (k, 2) and `corner_vertices`
    (c,): control vertices; `soft_creases`: pairs of them (k, 2) and weights (k,).
    """
    found, notes = [], []
    used = transfer.used_vertices()
    for axis in range(3):
        opposites = opposite(arrays.positions, axis, used)
        flat = not arrays.positions[used, axis].any()
        if opposites is None or flat:
            continue
        mirror = refined_mirror(transfer.patches, opposites, axis, transfer.vertex_count)
        if mirror is None or not maps_positions(mirror, arrays.positions):
            notes.append(
                f"The vertices are symmetric in {AXES[axis]} but the faces are not: no exact symmetry."
            )
        elif not (
            maps_pairs(mirror, crease_edges)
            and maps_pairs(mirror, *soft_creases)
            and maps_vertices(mirror, corner_vertices)
        ):
            notes.append(
                f"The mesh is symmetric in {AXES[axis]} but its creases are not: no exact symmetry."
            )
        else:
            found.append(mirror)
    return found, notes


def uneven_axes(vertices: np.ndarray, mirrors: list[Mirror]) -> list[str]:
    """Names of the axes in which `vertices` differ from their image by more than rounding:
    `symmetrize` leaves those.
    """
    uneven = (m for m in mirrors if not _differ_by_rounding(*_with_image(vertices, m)[1:]))
    return [AXES[mirror.axis] for mirror in uneven]


def symmetrize(
    vertices: np.ndarray, mirrors: list[Mirror], control_positions: np.ndarray | None = None
) -> np.ndarray:
    """`vertices` (N, 3) float64 of the refined surface, made exactly symmetric across all
    `mirrors`; a new array.

    Each vertex becomes the mean of itself and its partner's image, so opposite ones agree to the
    last bit in any precision, those on the plane get 0.0, and control vertices that are symmetric
    stay what they are. `control_positions` (n, 3): of the control mesh, or of a shape key; mirrors
    that it does not obey are left out.
    """
    for mirror in mirrors:
        if control_positions is None or maps_positions(mirror, control_positions):
            vertices = _mean_with_image(vertices, mirror)
    return vertices


def _mean_with_image(vertices: np.ndarray, mirror: Mirror) -> np.ndarray:
    moved, here, image = _with_image(vertices, mirror)
    if not _differ_by_rounding(here, image):
        return vertices
    out = vertices.copy()
    out[moved] = 0.5 * (here + image)
    return out


def _with_image(vertices: np.ndarray, mirror: Mirror) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ids of the vertices that have partners, their places, and those of their partners' images."""
    moved = np.flatnonzero(mirror.fine >= 0)
    here, image = vertices[moved], vertices[mirror.fine[moved]]
    image[:, mirror.axis] *= -1.0
    return moved, here, image


def _differ_by_rounding(here: np.ndarray, image: np.ndarray) -> bool:
    return not len(here) or np.abs(here - image).max() <= _ROUNDING * np.ptp(here, axis=0).max()
