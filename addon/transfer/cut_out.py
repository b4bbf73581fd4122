# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts a part out of a control mesh, so that fairing a few faces does not cost the whole."""

from dataclasses import dataclass, replace

import numpy as np

from ..core import ControlArrays
from ..triangles import marked


@dataclass(frozen=True)
class CutOut:
    """The `arrays` of some faces, and their ids."""

    arrays: ControlArrays
    vertices: np.ndarray  # (k,) ids of its vertices in the whole mesh
    faces: np.ndarray  # (f,) ids of its faces in the whole mesh


def grown(arrays: ControlArrays, chosen: np.ndarray, rings: int) -> np.ndarray:
    """(m,) bool: the faces `chosen` (m,) bool, and `rings` rings of faces around them."""
    for _ in range(rings):
        touched = marked(arrays.corners[chosen[arrays.face_of]], len(arrays.positions))
        chosen = chosen.copy()
        chosen[arrays.face_of[touched[arrays.corners]]] = True
    return chosen


def inside(arrays: ControlArrays, chosen: np.ndarray) -> np.ndarray:
    """(n,) bool: vertices all of whose faces are `chosen` (m,) bool, and that are not on a border."""
    in_chosen = chosen[arrays.face_of]
    found = marked(arrays.corners[in_chosen], len(arrays.positions))
    found[arrays.corners[~in_chosen]] = False
    found[arrays.border_edges.ravel()] = False
    return found


def cut_out(arrays: ControlArrays, chosen: np.ndarray) -> CutOut:
    """The faces `chosen` (m,) bool, in their order, with their vertices and edges."""
    faces = np.flatnonzero(chosen)
    kept = chosen[arrays.face_of]
    vertices, corners = np.unique(arrays.corners[kept], return_inverse=True)
    edges, corner_edges = np.unique(arrays.corner_edges[kept], return_inverse=True)
    renumbered = np.zeros(len(arrays.positions), np.int32)
    renumbered[vertices] = np.arange(len(vertices), dtype=np.int32)
    sizes = arrays.face_sizes[faces]

    def of(values: np.ndarray | None, ids: np.ndarray) -> np.ndarray | None:
        return None if values is None else values[ids]

    part = replace(
        arrays,
        positions=arrays.positions[vertices],
        edges=renumbered[arrays.edges[edges]],
        corners=corners.astype(np.int32),
        corner_edges=corner_edges.astype(np.int32),
        offsets=np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32),
        edge_crease=of(arrays.edge_crease, edges),
        vertex_crease=of(arrays.vertex_crease, vertices),
        sharp_edge=of(arrays.sharp_edge, edges),
        normals=of(arrays.normals, vertices),
        boundary_edge=of(_on_border(arrays), edges),
        flat_face=of(arrays.flat_face, faces),
    )
    return CutOut(part, vertices, faces)


def _on_border(arrays: ControlArrays) -> np.ndarray | None:
    """The marks of border edges only: a cut must not apply those of inner edges."""
    if arrays.boundary_edge is None:
        return None
    return np.where(arrays.edge_uses == 1, arrays.boundary_edge, 0)
