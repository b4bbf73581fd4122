# SPDX-License-Identifier: GPL-3.0-or-later
"""How two meshes join: gaps, kinks and jumps of curvature."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .border_fits import border_of
from .borders import Border, Mesh, mesh_arrays, unit_vectors


@dataclass(frozen=True)
class Joint:
    """A joint of two surfaces along their borders, measured at k places.

    vertex: (k,) border vertices of the first mesh. gap: (k,) the distance to the other's border, mesh
    units. kink: (k,) the angle between the tangent planes, radians. bend: (k, 2) the normal curvatures
    across the joint on both sides, 1 / mesh units. largest: the largest of all
    directions, places and sides.
    """

    vertex: np.ndarray
    gap: np.ndarray
    kink: np.ndarray
    bend: np.ndarray
    largest: float

    @property
    def jump(self) -> np.ndarray:
        """(k,): the curvature's jump, as a share of the largest curvature."""
        return np.abs(self.bend[:, 0] - self.bend[:, 1]) / max(self.largest, 1e-300)


def joint(first: Mesh, other: Mesh, reach: float | None = None) -> Joint:
    """Measures gap, kink and curvatures of two surfaces at the border vertices of the first.

    first, other: (vertices, faces), as fair() takes them, or with Result.faces. reach: mesh units, the
    largest distance of a border vertex of the first from the other's border; None: the mean border edge
    of the first. Ends of the joint and corners, which have no unique tangent, do not count.

    Raises FairingError BAD_SHAPE, and BAD_OPTION for a mesh without a border.
    """
    a, b = (border_of(*mesh_arrays(mesh)) for mesh in (first, other))
    if reach is None:
        reach = float(np.linalg.norm(np.diff(a.point[a.slot[a.edge]], axis=1), axis=2).mean())
    return joint_of(a, b, reach)


def joint_of(first: Border, other: Border, reach: float) -> Joint:
    """The joint where the first border is within `reach` of the other, without ends and corners, which
    have no unique tangent."""
    foot = other.at(first.point)
    gap = np.linalg.norm(foot.point - first.point, axis=1)
    near = gap <= reach
    a, b = first.slot[first.edge].T
    inside = np.zeros(len(near), int)
    step = first.point[b] - first.point[a]
    middle = (first.point[a] + first.point[b]) / 2
    aside = np.einsum("kj,kj->k", other.at(middle).point - middle, step)
    length2 = np.einsum("kj,kj->k", step, step)
    both = near[a] & near[b] & (np.abs(aside) < length2 / 4)  # not beyond the end
    np.add.at(inside, a, both)
    np.add.at(inside, b, both)
    straight = np.isin(np.arange(len(near)), first.ends[1, first.links[:, 1] >= 0])
    chosen = np.flatnonzero(near & (inside == 2) & straight)
    inward, across = first.inward[chosen], foot.inward[chosen]
    along = np.cross(first.normal[chosen], inward)
    across = unit_vectors(across - np.einsum("kj,kj->k", across, along)[:, None] * along)
    lean = np.einsum("kj,kj->k", first.normal[chosen], across)
    kink = np.abs(np.arctan2(lean, -np.einsum("kj,kj->k", inward, across)))
    bends = [
        np.einsum("ki,kij,kj->k", inward, first.bend[chosen], inward),
        np.einsum("ki,kij,kj->k", across, foot.bend[chosen], across),
    ]
    alike = np.sign(np.einsum("kj,kj->k", first.normal[chosen], foot.normal[chosen]))
    every = np.concatenate([first.bend[chosen], foot.bend[chosen]])
    largest = float(np.abs(np.linalg.eigvalsh(every)).max(initial=0.0)) if len(every) else 0.0
    across_both = np.stack([bends[0], alike * bends[1]], axis=1)
    return Joint(first.vertex[chosen], gap[chosen], kink, across_both, largest)
