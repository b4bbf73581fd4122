# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface as shown in the window, beside the one that patches are fitted to."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from .. import core, vertex_values
from ..blender import Context, Object
from ..errors import JobError
from ..inspection.curvature import unit
from ..mesh.read import control_mesh, read_mesh
from ..mesh.shape_keys import ShapeKeys, influences, mixed, read_shape_keys
from ..transfer.attributes import AttributeTransfer
from ..transfer.lattice import Cells, make_cells
from ..triangles import normals

Share = float | np.ndarray  # of a shape: one number, or one a control vertex


def shown_mesh(context: Context, shown: Object) -> core.ControlArrays:
    """The mesh of `shown` with its mix of shape keys, without modifiers, in its own coordinates."""
    with control_mesh(context, shown) as mesh:
        arrays = read_mesh(mesh)
        keys = read_shape_keys(shown, len(arrays.positions))
        if keys is None:
            return arrays
        count = len(arrays.positions)
        positions = mixed(
            keys,
            lambda group: (
                vertex_values.factors(shown, mesh, group)
                if group in shown.vertex_groups
                else np.ones(count)
            ),
        )
    return replace(arrays, positions=positions)


def shares_of(
    shown: Object, keys: ShapeKeys, groups: Sequence[Any], vertex_count: int
) -> dict[int, Share]:
    """Shares of the source's `keys` in the mix, by the sliders of `shown` with the same names; the
    result of `influences`. `groups`: the vertex groups of the source. Raises JobError if keys of
    `shown` itself take part, which the fitted surface does not have.
    """
    its = read_shape_keys(shown, len(shown.data.vertices))
    if its is None:
        return {}
    dense = {group.name: group.dense(vertex_count) for group in groups}
    found = influences(its, lambda name: dense.get(name, np.ones(vertex_count, np.float32)))
    places = {key.name: place for place, key in enumerate(keys.keys)}
    names = {place: its.keys[place].name for place in found}
    own = [name for name in names.values() if name not in places]
    if own:
        raise JobError(own_keys_text(shown.name, own))
    return {places[name]: found[place] for place, name in names.items() if places[name]}


def own_keys_text(name: str, own: Sequence[str]) -> str:
    keys = f"{'key' if len(own) == 1 else 'keys'} {', '.join(own)}"
    return (
        f"{name}: Set the {keys} to 0, or give the source such a key and make the surface again. Patches are fitted to "
        f"the fair surface, which does not have the {keys} of its mesh."
    )


class Blend:
    """The `blend` of `discrete_fairing.fit_patches`: mixes the surface and its shapes with one share
    `of_shapes` for each shape; `arrays`: the control mesh.
    """

    def __init__(self, arrays: core.ControlArrays, of_shapes: Sequence[Share]) -> None:
        self._arrays, self._influences = arrays, of_shapes

    def __call__(self, result: Any, levels: int) -> np.ndarray:
        found = result.vertices.copy()
        for share, shape in zip(self._influences, result.shapes, strict=True):
            if np.ndim(share):
                share = AttributeTransfer(result, self._arrays, levels).point(np.asarray(share))
            found += share * (shape - result.vertices)
        return found


def distance(
    result: Any,
    control: core.ControlArrays,
    levels: int,
    vertices: np.ndarray,
    mesh: core.ControlArrays,
) -> float | None:
    """The largest distance, along normals, between the surface `result` of `levels` for the mesh
    `control`, with its `vertices` (N, 3), and the `mesh` shown, in the same coordinates, at common
    points. None if the mesh has other faces than such a surface.
    """
    transfer = AttributeTransfer(result, control, levels)
    pairs = _same_points(transfer, levels, mesh.corners)
    if pairs is None:
        return None
    there, here = pairs
    outward = unit(normals(vertices, result.triangles))[here]
    gap = np.einsum("ij,ij->i", mesh.positions[there] - vertices[here], outward)
    return float(np.abs(gap).max(initial=0.0))


def _same_points(
    transfer: AttributeTransfer, levels: int, corners: np.ndarray
) -> tuple[np.ndarray, np.ndarray] | None:
    """Ids of refined vertices with `corners`, and those of `transfer` there; or None."""
    at_level_0 = sum(patch.fine.size for patch in transfer.patches) >> 2 * levels
    own = next((k for k in range(levels + 9) if at_level_0 << 2 * k == len(corners)), None)
    if own is None or not at_level_0:
        return None
    common, first, pairs = min(own, levels), 0, []
    for patch in transfer.patches:
        faces, size = len(patch.faces.polygon), patch.faces.size
        last = first + (faces * size << 2 * own)
        cells = make_cells(size, own)
        there = corners[first:last].reshape(faces, -1)[:, cells.first_corner]
        here = patch.fine.reshape(faces, -1)[:, patch.cells.first_corner]
        pairs.append(
            (
                there[:, _points_of(cells, own - common)].ravel(),
                here[:, _points_of(patch.cells, levels - common)].ravel(),
            )
        )
        first = last
    ids, vertices = (np.concatenate(parts) for parts in zip(*pairs, strict=True))
    return ids, vertices


def _points_of(cells: Cells, finer: int) -> np.ndarray:
    """Rows of the points of a face that exist with `finer` levels less, in their order."""
    return np.flatnonzero((cells.points % 2**finer == 0).all(axis=1))
