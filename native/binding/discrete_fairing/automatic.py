# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes that are better served with flats kept, or by Subdivision Surface, known by their shape."""

from __future__ import annotations

from typing import Any, Literal, TypeAlias

import numpy as np

from .arrays import following, marked
from .control_mesh import ControlMesh
from .converters import vertex_pairs
from .flats import ANGLE, SPACING, Parts, flats_of, halves_of_quads, kept_faces, straights_of
from .swelling import swells_into_itself

# through the vertices; the same with the faces of find_flats() kept flat; limit positions
Choice: TypeAlias = Literal["exact", "flats", "limit"]

# Degrees. Through the vertices, walls of a slit cross each other where they are less than 60, 45 or 20 apart, if the faces
# at its bottom are 0.3, 0.6 or 1.2 times as deep as the prongs beside it are thick.
SLIT = 30.0
# Degrees. Faces beside an edge that turns by more bulge or fold if flats are kept: wedges, corners of hollows.
_BEVEL = 75.0
# settings that decide for "exact": limit positions exclude them, or they make a fold a crease
_EXACT = ("normals", "flat_faces", "region", "crease_angle")
_OF_LIMIT = ("limit", "edge_sharpness", "vertex_sharpness")


def resolved(
    settings: dict[str, Any], points: np.ndarray, corners: np.ndarray, offsets: np.ndarray
) -> dict[str, Any]:
    """The settings with interpolation "auto" replaced: "limit", or None, so that a tolerance or weights make it
    "approximate"; with `flat_faces` and their spacing where flats are kept.
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
    may_keep = settings.get("energy") in (None, "thin_plate") and not any(
        settings.get(name) is not None for name in _OF_LIMIT
    )
    found = choice(mesh, sharp, may_keep)
    if found == "flats":
        taken["flat_faces"] = np.flatnonzero(kept_faces(mesh, ANGLE, sharp))
        taken["metric_exponent"] = max(settings.get("metric_exponent") or 0.0, SPACING)
    return {**settings, "interpolation": "limit"} if found == "limit" else taken


def choice(mesh: ControlMesh, sharp: np.ndarray, may_keep: bool = True) -> Choice:
    """What suits a mesh best, with the edges `sharp`, (e,) bool. `may_keep`: whether flats can be kept.

    "limit": walls are so close that they would swell into each other, as between fingers; or it is closed, with
    flats between tight rims of quads, a flat floor in a hollow, or slits. Through its vertices such a mesh is
    quilted; the floor and the walls of a hollow swing into what is behind them, and those of a slit into each other. "flats": it is closed and bevelled all around, with walls that are straight,
    as a phone, a can or a cup; limit positions make it smaller, or a hollow larger. "exact": all others. Other open
    meshes are measured sheets, hulls and terrain as often as they are cages, and subdivision folds faces that are
    not star-shaped.
    """
    uses = mesh.edge_uses
    if not uses.any() or (uses > 2).any():
        return "exact"
    if (uses == 1).any():
        return "limit" if _swells(mesh, sharp) and _are_star_shaped(mesh) else "exact"
    parts = Parts.of(mesh, ANGLE, sharp)
    slits = _has_slits(mesh, sharp)
    if may_keep and not slits and _is_bevelled(parts, sharp):
        return "flats"
    suits = slits or _has_floor(parts, sharp) or _has_rims(mesh, flats_of(parts, tight=True))
    suits = suits or _has_chamfers_of_triangles(parts, sharp) or _swells(mesh, sharp)
    return "limit" if suits and _are_star_shaped(mesh) else "exact"


def _is_bevelled(parts: Parts, sharp: np.ndarray) -> bool:
    folds, inside = parts.mesh.fold_angles
    mild = (folds[inside & ~sharp] <= _BEVEL).all()
    return bool(mild and straights_of(parts).any())


def _are_star_shaped(mesh: ControlMesh) -> bool:
    """Whether no side of a face is seen from behind by the mean of its corners, where subdivision splits it; seen
    across a warped face it does no harm.
    """
    spokes = mesh.positions[mesh.corners] - mesh.face_centres[mesh.face_of]
    cross, vectors = (
        np.cross(spokes, spokes[following(mesh.offsets)]),
        mesh.face_vectors[mesh.face_of],
    )
    least = (
        -np.cos(np.radians(SLIT)) * np.linalg.norm(cross, axis=1) * np.linalg.norm(vectors, axis=1)
    )
    return bool(((cross * vectors).sum(axis=1) > least)[mesh.face_sizes[mesh.face_of] > 4].all())


def _swells(mesh: ControlMesh, sharp: np.ndarray) -> bool:
    """Whether walls beside edges that turn by over SLIT, none of them `sharp`, swell into each other."""
    folds, inside = mesh.fold_angles
    turns = np.where(inside & ~sharp & (folds > SLIT), np.radians(folds), 0.0)
    turns *= -np.sign(_rises(mesh, *mesh.faces_of_edges.T))
    return swells_into_itself(mesh, turns, _outwards(mesh) * mesh.face_normals)


def _has_slits(mesh: ControlMesh, sharp: np.ndarray) -> bool:
    """Whether walls that are less than SLIT apart meet inwards, by no `sharp` edge, as between fingers."""
    folds, inside = mesh.fold_angles
    narrow = inside & ~sharp & (folds > 180.0 - SLIT)
    return bool((narrow & (_rises(mesh, *mesh.faces_of_edges.T) > 0.0)).any())


def _has_floor(parts: Parts, sharp: np.ndarray) -> bool:
    """Whether the mesh turns inwards along the whole border of a plane part, by no `sharp` edge."""
    mesh, part, plane = parts.mesh, parts.part, parts.plane.copy()
    folds, inside = mesh.fold_angles
    bent, pair = inside & ~sharp & (folds > ANGLE), mesh.faces_of_edges
    for here, there in (pair.T, pair.T[::-1]):
        border = part[here] != part[there]
        plane[part[here[border & ~(bent & (_rises(mesh, here, there) > 0.0))]]] = False
    return bool(plane.any())


def _rises(mesh: ControlMesh, here: np.ndarray, there: np.ndarray) -> np.ndarray:
    """(e,) how far the faces `there` rise above those `here` on the outside, times twice their areas."""
    vectors, middles = mesh.face_vectors, mesh.face_centres
    rise = (vectors[here] * (middles[there] - middles[here])).sum(axis=1)
    return np.asarray(_outwards(mesh) * rise)


def _outwards(mesh: ControlMesh) -> float:
    """1 if the faces look outwards, -1 if inwards."""
    middles = mesh.face_centres
    return float(np.sign((mesh.face_vectors * (middles - middles.mean(axis=0))).sum()))


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


def _has_chamfers_of_triangles(parts: Parts, sharp: np.ndarray) -> bool:
    """The same of faces that are two triangles each: how many meet at a vertex tells nothing then."""
    mesh = parts.mesh
    if not (mesh.face_sizes == 3).any():
        return False
    folds, inside = mesh.fold_angles
    other = halves_of_quads(mesh, inside & ~sharp & (folds <= ANGLE))
    flats = flats_of(parts, tight=True, other_half=other)
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
