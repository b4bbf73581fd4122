# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact symmetry: finds vertices that are mirror images of each other, and makes surfaces as symmetric
as their control meshes.

Nothing is matched by nearness. Each control vertex has a colour, a number of 64 bits mixed from its
position and those of its neighbours [Weisfeiler and Lehman 1968], and its image has another one; a
refined vertex has the same sums of colours as of positions. Partners have the colours of each other's
images. Solvers round, and differently on both sides: hence `symmetrize`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core import ControlArrays
from .attributes import AttributeTransfer, Patch
from .lattice import pair_keys

AXES = "XYZ"
NONE = -1  # the image of a vertex without faces

# relative to the surface's size; a larger difference is no rounding but another asymmetry
_ROUNDING = 1e-4


@dataclass(frozen=True)
class Mirror:
    """A plane through the origin across which a control mesh is its own mirror image."""

    axis: int  # 0, 1 or 2: the coordinate that changes its sign
    # (n,) int32: the image of each control vertex, NONE for those without a face
    control: np.ndarray
    fine: np.ndarray  # (N,) int32: the same for the refined vertices


def _mixed(values: np.ndarray) -> np.ndarray:
    """Hashes numbers of 64 bits [Steele, Lea and Flood 2014]."""
    values = (values ^ (values >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    values = (values ^ (values >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return values ^ (values >> np.uint64(31))


def _of_places(positions: np.ndarray) -> np.ndarray:
    """(n,) colours, equal at equal positions."""
    colours = np.zeros(len(positions), np.uint64)
    for column in (positions + 0.0).T:  # + 0 turns a negative zero into zero
        colours = _mixed(colours + np.ascontiguousarray(column, np.float64).view(np.uint64))
    return colours


def _with_neighbours(colours: np.ndarray, patches: list[Patch]) -> np.ndarray:
    """The colours after a round, in which those of the sides of all faces around are mixed in."""
    total = np.zeros_like(colours)
    for patch in patches:
        own = colours[patch.faces.vertices]
        faces = _mixed(own + np.roll(own, -1, axis=1)).sum(axis=1, dtype=np.uint64)
        np.add.at(total, patch.faces.vertices, _mixed(faces)[:, None])
    return _mixed(colours + total)


def _refined(patches: list[Patch], colours: np.ndarray, count: int) -> np.ndarray:
    """(count,) colours of the refined vertices: sums over the corners with integer weights."""
    found = np.zeros(count, np.uint64)
    for patch in patches:
        weights = patch.cells.weights * patch.cells.lattice.n**2
        ids = patch.fine.reshape(len(patch.faces.polygon), -1)[:, patch.cells.first_corner]
        found[ids] = colours[patch.faces.vertices] @ weights.T.astype(np.uint64)
    return found


def _partners(own: np.ndarray, image: np.ndarray, used: np.ndarray) -> np.ndarray | None:
    """(n,) the `used` vertex with the colour of each one's image; None if colours differ."""
    ids = np.flatnonzero(used)
    order, image_order = (ids[np.argsort(values[ids], kind="stable")] for values in (own, image))
    if not np.array_equal(own[order], image[image_order]):
        return None
    found = np.full(len(own), NONE, np.int32)
    found[image_order] = order
    return found


def _mirror(
    transfer: AttributeTransfer, own: np.ndarray, image: np.ndarray, axis: int
) -> Mirror | None:
    """The Mirror of a mesh with these colours of vertices and images; None if asymmetric."""
    patches, count = transfer.patches, transfer.control_count
    ids = max(count, *(int(patch.faces.vertices.max()) + 1 for patch in patches))  # with centres
    own, image = (np.append(c, np.zeros(ids - count, np.uint64)) for c in (own, image))
    known, distinct = -1, 0
    while distinct > known:  # neighbours distinguish coincident vertices
        own, image = _with_neighbours(own, patches), _with_neighbours(image, patches)
        known, distinct = distinct, len(np.unique(own))
    used = np.zeros(ids, bool)
    reached = np.zeros(transfer.vertex_count, bool)
    for patch in patches:
        used[patch.faces.vertices] = True
        reached[patch.fine] = True
    control = _partners(own, image, used)
    if control is None:
        return None
    own, image = (_refined(patches, colours, transfer.vertex_count) for colours in (own, image))
    fine = _partners(own, image, reached)
    return None if fine is None else Mirror(axis, control[:count], fine)


def maps_pairs(
    mirror: Mirror,
    pairs: np.ndarray | Sequence[Any],
    values: np.ndarray | Sequence[float] | float = 0.0,
) -> bool:
    """Whether the vertex `pairs` (k, 2) with their `values` (k,) are a symmetric set."""
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
    """Whether `positions` (n, 3) of the control vertices are exact mirror images."""
    used = mirror.control >= 0
    image = positions[mirror.control[used]]
    image[:, mirror.axis] *= -1.0
    return np.array_equal(positions[used], image)


def find_mirrors(
    transfer: AttributeTransfer,
    arrays: ControlArrays,
    crease_edges: np.ndarray | Sequence[Any] = (),
    corner_vertices: np.ndarray | Sequence[Any] = (),
    soft_creases: tuple[Any, Any] = ((), ()),
) -> tuple[list[Mirror], list[str]]:
    """The planes x = 0, y = 0, z = 0 across which control mesh and features are symmetric: (list of
    Mirror, notes).

    `transfer`: AttributeTransfer; `arrays`: the control mesh; `crease_edges` (k, 2) and
    `corner_vertices` (c,): control vertices; `soft_creases`: pairs of them (k, 2) and weights (k,).
    """
    found, notes = [], []
    used, own = transfer.used_vertices(), _of_places(arrays.positions)
    for axis in range(3):
        image = arrays.positions.copy()
        image[:, axis] *= -1.0
        opposite = _of_places(image)
        flat = not arrays.positions[used, axis].any()
        if flat or _partners(own, opposite, used) is None:
            continue
        mirror = _mirror(transfer, own, opposite, axis)
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
    """Axes in which `vertices` differ from their images; `symmetrize` leaves these out."""
    uneven = (m for m in mirrors if not _differ_by_rounding(*_with_image(vertices, m)[1:]))
    return [AXES[mirror.axis] for mirror in uneven]


def symmetrize(
    vertices: np.ndarray, mirrors: list[Mirror], control_positions: np.ndarray | None = None
) -> np.ndarray:
    """`vertices` (N, 3) float64 of the refined surface, made exactly symmetric across all `mirrors`; a
    new array.

    Each vertex becomes the mean of itself and its partner's image, so that opposite ones agree to the
    last bit in any precision, those on the plane get 0.0, and symmetric control vertices are unchanged.
    `control_positions` (n, 3): of the control mesh, or of a shape key; mirrors across which it is not
    symmetric are left out.
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
    """Ids of the vertices with partners, their positions, and those of their partners' images."""
    moved = np.flatnonzero(mirror.fine >= 0)
    here, image = vertices[moved], vertices[mirror.fine[moved]]
    image[:, mirror.axis] *= -1.0
    return moved, here, image


def _differ_by_rounding(here: np.ndarray, image: np.ndarray) -> bool:
    return not len(here) or np.abs(here - image).max() <= _ROUNDING * np.ptp(here, axis=0).max()
