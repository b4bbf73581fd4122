# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes that Subdivision Surface serves better than their own vertices, known by their shape."""

from __future__ import annotations

from typing import Any

import numpy as np

from .arrays import marked
from .control_mesh import ControlMesh
from .converters import vertex_pairs
from .flats import ANGLE, flats_of, halves_of_quads, plane_parts

# Degrees. Through the vertices, walls of a slit cross each other where they are less than 60, 45 or 20 apart, if the faces
# at its bottom are 0.3, 0.6 or 1.2 times as deep as the prongs beside it are thick.
SLIT = 30.0
# settings that decide for "exact": limit positions exclude them, or they make a fold a crease
_EXACT = ("normals", "flat_faces", "region", "crease_angle")


def resolved(
    settings: dict[str, Any], points: np.ndarray, corners: np.ndarray, offsets: np.ndarray
) -> dict[str, Any]:
    """The settings with interpolation "auto" replaced: None, so that a tolerance or weights make it
    "approximate", or "limit".
    """
    if settings.get("interpolation") != "auto":
        return settings
    taken = {**settings, "interpolation": None}
    if any(settings.get(name) is not None for name in (*_EXACT, "tolerance", "weights")):
        return taken
    used = (corners >= 0) & (corners < len(points))
    if (
        not len(corners)
        or not used.all()
        or not np.isfinite(points).all()
        or (np.diff(offsets) < 3).any()
    ):
        return taken  # the core names the defects
    mesh = ControlMesh.of(points, corners, offsets)
    sharp = np.zeros(len(mesh.edges), bool)
    for name in ("crease_edges", "edge_sharpness"):
        given = settings.get(name)
        if given is not None:
            pairs = vertex_pairs(name, given[0] if name == "edge_sharpness" else given)
            sharp |= mesh.has_pair(pairs)
    return {**settings, "interpolation": "limit"} if wants_limit(mesh, sharp) else taken


def wants_limit(mesh: ControlMesh, sharp: np.ndarray) -> bool:
    """Whether limit positions suit a mesh, with the edges `sharp`, (e,) bool, better than its vertices: it
    is closed, with flats between tight rims of quads, a flat floor in a hollow, or slits.

    Through its vertices such a mesh is quilted, and with stiff flats its rims bulge; the floor and the walls
    of a hollow swing into what is behind them, and those of a slit into each other. Open meshes are measured
    sheets, hulls and terrain as often as they are cages.
    """
    uses = mesh.edge_uses
    if not uses.any() or not np.isin(uses, (0, 2)).all():
        return False
    return (
        _has_slits(mesh, sharp)
        or _has_floor(mesh, sharp)
        or _has_rims(mesh, flats_of(mesh, ANGLE, sharp, tight=True))
        or _has_chamfers_of_triangles(mesh, sharp)
    )


def _has_slits(mesh: ControlMesh, sharp: np.ndarray) -> bool:
    """Whether walls that are less than SLIT apart meet inwards, by no `sharp` edge, as between fingers."""
    folds, inside = mesh.fold_angles
    narrow = inside & ~sharp & (folds > 180.0 - SLIT)
    return bool((narrow & (_rises(mesh, *mesh.faces_of_edges.T) > 0.0)).any())


def _has_floor(mesh: ControlMesh, sharp: np.ndarray) -> bool:
    """Whether the mesh turns inwards along the whole border of a plane part, by no `sharp` edge."""
    folds, inside = mesh.fold_angles
    bent = inside & ~sharp & (folds > ANGLE)
    part, plane = plane_parts(mesh, inside & ~sharp & (folds <= ANGLE))
    pair = mesh.faces_of_edges
    for here, there in (pair.T, pair.T[::-1]):
        border = part[here] != part[there]
        plane[part[here[border & ~(bent & (_rises(mesh, here, there) > 0.0))]]] = False
    return bool(plane.any())


def _rises(mesh: ControlMesh, here: np.ndarray, there: np.ndarray) -> np.ndarray:
    """(e,) how far the faces `there` rise above those `here` on the outside, times twice their areas."""
    vectors, middles = mesh.face_vectors, mesh.face_centres
    outwards = np.sign((vectors * (middles - middles.mean(axis=0))).sum())
    return np.asarray(outwards * (vectors[here] * (middles[there] - middles[here])).sum(axis=1))


def _has_rims(mesh: ControlMesh, flats: np.ndarray) -> bool:
    """Whether loops run along the borders of `flats`, or faces beside them turn on their other side too, as a
    chamfer does. Boxes and prisms have neither.
    """
    if not flats.any():
        return False
    faces_at = np.bincount(mesh.corners)
    if (faces_at[mesh.corners[np.repeat(flats, mesh.face_sizes)]] > 3).any():
        return True
    return _turns_beyond(mesh, flats | _beside(mesh, flats))


def _has_chamfers_of_triangles(mesh: ControlMesh, sharp: np.ndarray) -> bool:
    """The same of faces that are two triangles each: how many meet at a vertex tells nothing then."""
    if not (mesh.face_sizes == 3).any():
        return False
    folds, inside = mesh.fold_angles
    other = halves_of_quads(mesh, inside & ~sharp & (folds <= ANGLE))
    flats = flats_of(mesh, ANGLE, sharp, tight=True, other_half=other)
    known = flats | _beside(mesh, flats)
    known |= (other >= 0) & known[other]
    return _turns_beyond(mesh, known)


def _beside(mesh: ControlMesh, faces: np.ndarray) -> np.ndarray:
    pair = mesh.faces_of_edges
    return marked(pair[faces[pair].any(axis=1)], len(faces))


def _turns_beyond(mesh: ControlMesh, known: np.ndarray) -> bool:
    """Whether the mesh turns at an edge of the faces `known`."""
    border = known[mesh.faces_of_edges].sum(axis=1) == 1
    return bool((mesh.fold_angles[0][border] > ANGLE).any())
