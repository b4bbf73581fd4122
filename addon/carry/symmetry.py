# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of exactly symmetric control meshes made exactly symmetric: solvers round, and not alike on both sides."""

import numpy as np

from .mirror import AXES, maps_pairs, maps_positions, maps_vertices, opposite, refined_mirror

_ROUNDING = 1e-4  # of the surface's size; more is no rounding: then something else is not symmetric


def find_mirrors(carrier, arrays, crease_edges=(), corner_vertices=()):
    """The planes x = 0, y = 0, z = 0 across which control mesh and features are symmetric: (list of Mirror, notes).

    `carrier`: Carrier; `arrays`: the control mesh; `crease_edges` (k, 2) and `corner_vertices` (c,): control vertices.
    """
    found, notes = [], []
    used = carrier.used_vertices()
    for axis in range(3):
        opposites = opposite(arrays.positions, axis, used)
        flat = not arrays.positions[used, axis].any()
        if opposites is None or flat:
            continue
        mirror = refined_mirror(carrier.patches, opposites, axis, carrier.vertex_count)
        if mirror is None or not maps_positions(mirror, arrays.positions):
            notes.append(
                f"The vertices are symmetric in {AXES[axis]} but the faces are not: no exact symmetry."
            )
        elif not (maps_pairs(mirror, crease_edges) and maps_vertices(mirror, corner_vertices)):
            notes.append(f"The mesh is symmetric in {AXES[axis]} but its creases are not: no exact symmetry.")
        else:
            found.append(mirror)
    return found, notes


def uneven_axes(vertices, mirrors):
    """Names of the axes in which `vertices` differ from their image by more than rounding: `symmetrize` leaves those."""
    uneven = (m for m in mirrors if not _differ_by_rounding(*_with_image(vertices, m)[1:]))
    return [AXES[mirror.axis] for mirror in uneven]


def symmetrize(vertices, mirrors, control_positions=None):
    """`vertices` (N, 3) float64 of the refined surface, made exactly symmetric across all `mirrors`; a new array.

    Each vertex becomes the mean of itself and its partner's image, so opposite ones agree to the last bit in any
    precision, those on the plane get 0.0, and control vertices that are symmetric stay what they are.
    `control_positions` (n, 3): of the control mesh, or of a shape key; mirrors that it does not obey are left out.
    """
    for mirror in mirrors:
        if control_positions is None or maps_positions(mirror, control_positions):
            vertices = _mean_with_image(vertices, mirror)
    return vertices


def _mean_with_image(vertices, mirror):
    moved, here, image = _with_image(vertices, mirror)
    if not _differ_by_rounding(here, image):
        return vertices
    out = vertices.copy()
    out[moved] = 0.5 * (here + image)
    return out


def _with_image(vertices, mirror):
    """Ids of the vertices that have partners, their places, and those of their partners' images."""
    moved = np.flatnonzero(mirror.fine >= 0)
    here, image = vertices[moved], vertices[mirror.fine[moved]]
    image[:, mirror.axis] *= -1.0
    return moved, here, image


def _differ_by_rounding(here, image):
    return not len(here) or np.abs(here - image).max() <= _ROUNDING * np.ptp(here, axis=0).max()
