# SPDX-License-Identifier: GPL-3.0-or-later
"""Cages that Subdivision Surface serves better than their own vertices, known by their shape."""

import numpy as np

from .. import core
from ..blender import Mesh, Object
from ..mesh.mesh_changes import shown
from ..mesh.read import read_mesh
from ..mesh.world_shape import world_shape
from ..properties import FairingSettings
from ..settings import Settings, is_evaluated, subdivision
from ..triangles import marked
from .flats import ANGLE, find_flats, halves_of_quads, plane_parts

REASON = "flat faces at tight rims or in hollows"


def _is_auto(settings: Settings) -> bool:
    """Whether the shape decides. Where folds become sharp, a fold is no rim."""
    return settings.interpolation == "AUTO" and not (
        settings.use_selection or settings.use_crease_angle
    )


def wants_limit(settings: Settings, cage: core.ControlArrays) -> bool:
    """Whether AUTO is LIMIT for the shape of `cage` in the world: closed, with flats between tight rims of
    quads or a flat floor in a hollow, none of them kept flat.

    Through its vertices such a cage is quilted, and with stiff flats its rims bulge; the floor and the walls
    of a hollow swing into what is behind them. Open meshes are measured sheets, hulls and terrain as often as
    they are cages.
    """
    uses = cage.edge_uses
    marked = cage.flat_face is not None and cage.flat_face.any()
    is_closed = uses.any() and np.isin(uses, (0, 2)).all()
    if not _is_auto(settings) or marked or not is_closed:
        return False
    sharp = np.zeros(len(uses), bool)
    if settings.use_crease_attribute and cage.edge_crease is not None:
        sharp |= cage.edge_crease > 0
    if settings.use_sharp_edges and cage.sharp_edge is not None:
        sharp |= cage.sharp_edge
    return (
        _has_floor(cage, sharp)
        or _has_rims(cage, find_flats(cage, ANGLE, sharp, tight=True))
        or _has_chamfers_of_triangles(cage, sharp)
    )


def _has_floor(cage: core.ControlArrays, sharp: np.ndarray) -> bool:
    """Whether the mesh turns inwards along the whole border of a plane part, by no `sharp` edge."""
    folds, inside = cage.fold_angles
    bent = inside & ~sharp & (folds > ANGLE)
    part, plane = plane_parts(cage, inside & ~sharp & (folds <= ANGLE))
    pair, vectors, middles = cage.faces_of_edges, cage.face_vectors, cage.face_centres
    outwards = np.sign((vectors * (middles - middles.mean(axis=0))).sum())
    for here, there in (pair.T, pair.T[::-1]):
        rise = (vectors[here] * (middles[there] - middles[here])).sum(axis=1)
        border = part[here] != part[there]
        plane[part[here[border & ~(bent & (outwards * rise > 0.0))]]] = False
    return bool(plane.any())


def _has_rims(cage: core.ControlArrays, flats: np.ndarray) -> bool:
    """Whether loops run along the borders of `flats`, or faces beside them turn on their other side too, as a
    chamfer does. Boxes and prisms have neither.
    """
    if not flats.any():
        return False
    faces_at = np.bincount(cage.corners)
    if (faces_at[cage.corners[np.repeat(flats, cage.face_sizes)]] > 3).any():
        return True
    return _turns_beyond(cage, flats | _beside(cage, flats))


def _has_chamfers_of_triangles(cage: core.ControlArrays, sharp: np.ndarray) -> bool:
    """The same of faces that are two triangles each: how many meet at a vertex tells nothing then."""
    if not (cage.face_sizes == 3).any():
        return False
    folds, inside = cage.fold_angles
    other = halves_of_quads(cage, inside & ~sharp & (folds <= ANGLE))
    flats = find_flats(cage, ANGLE, sharp, tight=True, other_half=other)
    known = flats | _beside(cage, flats)
    known |= (other >= 0) & known[other]
    return _turns_beyond(cage, known)


def _beside(cage: core.ControlArrays, faces: np.ndarray) -> np.ndarray:
    pair = cage.faces_of_edges
    return marked(pair[faces[pair].any(axis=1)], len(faces))


def _turns_beyond(cage: core.ControlArrays, known: np.ndarray) -> bool:
    """Whether the mesh turns at an edge of the faces `known`."""
    border = known[cage.faces_of_edges].sum(axis=1) == 1
    return bool((cage.fold_angles[0][border] > ANGLE).any())


def shown_settings(properties: FairingSettings, source: Object) -> Settings | None:
    """The settings with which `source` will be faired, for panels, AUTO resolved; None in Edit Mode, and with
    modifiers, if its shape decides.
    """
    settings = Settings.of(properties)
    if not _is_auto(settings) or subdivision(source) is not None:
        return settings.for_source(source)
    if source.mode == "EDIT" or (is_evaluated(settings) and source.modifiers):
        return None
    shape = world_shape(source)

    def measure(mesh: Mesh) -> bool:
        return wants_limit(settings, shape.of_arrays(read_mesh(mesh)))

    name = "cage", shape.rows, settings.use_crease_attribute, settings.use_sharp_edges
    return settings.for_source(source, shown(source.data, name, measure, False))
