# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface as shown in the window, beside the one that patches are fitted to."""

from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from .. import core
from ..blender import Context, Object
from ..errors import JobError
from ..mesh.read import control_mesh, read_mesh
from ..mesh.shape_keys import ShapeKeys, influences, mixed_positions, read_shape_keys
from ..transfer.attributes import AttributeTransfer

Share = float | np.ndarray  # of a shape: one number, or one a control vertex


def shown_mesh(context: Context, shown: Object) -> core.ControlArrays:
    """The mesh of `shown` with its mix of shape keys, without modifiers, in its own coordinates."""
    with control_mesh(context, shown) as mesh:
        arrays = read_mesh(mesh)
        return replace(arrays, positions=mixed_positions(shown, mesh, arrays.positions))


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
    dense = {group.name: group.dense for group in groups}
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
    result: Any, levels: int, vertices: np.ndarray, mesh: core.ControlArrays
) -> float | None:
    """The largest distance, along normals, between the surface `result` of `levels`, with its `vertices`
    (N, 3), and the `mesh` shown, in the same coordinates, at common points. None if the mesh has other
    faces than such a surface.
    """
    triangles = int((mesh.face_sizes == 3).sum())
    counts = [triangles, len(mesh.face_sizes) - triangles]
    at_0 = [len(faces) >> 2 * levels for faces in result.faces]
    own = next((k for k in range(levels + 9) if [n << 2 * k for n in at_0] == counts), None)
    if own is None or not any(at_0) or len(mesh.corners) != 3 * counts[0] + 4 * counts[1]:
        return None
    faces = np.split(mesh.corners, [3 * triangles])
    shown = SimpleNamespace(
        vertices=mesh.positions, faces=(faces[0].reshape(-1, 3), faces[1].reshape(-1, 4))
    )
    both = shown, SimpleNamespace(vertices=vertices, faces=result.faces)
    coarse, fine = both if own <= levels else both[::-1]
    change = core.module().level_change.change_between(
        coarse, fine, max(own, levels), abs(own - levels)
    )
    return float(change.max(initial=0.0))
