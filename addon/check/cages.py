# SPDX-License-Identifier: GPL-3.0-or-later
"""Cages that Subdivision Surface serves better than their own vertices, known by their shape."""

import numpy as np

from .. import core
from ..blender import Mesh, Object
from ..inspection.curvature import faces_of_edges
from ..inspection.measures import fold_angles
from ..mesh.mesh_changes import shown
from ..mesh.read import read_mesh
from ..mesh.world_shape import world_shape
from ..properties import FairingSettings
from ..settings import Settings, is_evaluated, subdivision
from ..triangles import marked
from .flats import ANGLE, find_flats

REASON = "flat faces between tight rims"


def _is_auto(settings: Settings) -> bool:
    """Whether the shape decides. Where folds become sharp, a fold is no rim."""
    return settings.interpolation == "AUTO" and not (
        is_evaluated(settings) or settings.use_selection or settings.use_crease_angle
    )


def wants_limit(settings: Settings, cage: core.ControlArrays) -> bool:
    """Whether AUTO is LIMIT for the shape of `cage` in the world: closed, with flats between tight rims of
    quads, none of them kept flat.

    Through its vertices such a cage is quilted, and with stiff flats its rims bulge. Open meshes are measured
    sheets, hulls and terrain as often as they are cages.
    """
    uses = cage.edge_uses
    marked = cage.flat_face is not None and cage.flat_face.any()
    if not _is_auto(settings) or marked or not np.isin(uses, (0, 2)).all():
        return False
    sharp = np.zeros(len(uses), bool)
    if settings.use_crease_attribute and cage.edge_crease is not None:
        sharp |= cage.edge_crease > 0
    if settings.use_sharp_edges and cage.sharp_edge is not None:
        sharp |= cage.sharp_edge
    return _has_rims(cage, find_flats(cage, ANGLE, sharp, tight=True))


def _has_rims(cage: core.ControlArrays, flats: np.ndarray) -> bool:
    """Whether loops run along the borders of `flats`, or faces beside them turn on their other side too, as a
    chamfer does. Boxes and prisms have neither.
    """
    if not flats.any():
        return False
    faces_at = np.bincount(cage.corners)
    if (faces_at[cage.corners[np.repeat(flats, cage.face_sizes)]] > 3).any():
        return True
    pair = faces_of_edges(cage)
    known = flats | marked(pair[flats[pair].any(axis=1)], len(flats))
    beyond = known[pair].sum(axis=1) == 1
    return bool((fold_angles(cage)[0][beyond] > ANGLE).any())


def shown_settings(properties: FairingSettings, source: Object) -> Settings | None:
    """The settings with which `source` will be faired, for panels, AUTO resolved; None in Edit Mode if
    its shape decides.
    """
    settings = Settings.of(properties)
    if not _is_auto(settings) or subdivision(source) is not None:
        return settings.for_source(source)
    if source.mode == "EDIT":
        return None
    shape = world_shape(source)

    def measure(mesh: Mesh) -> bool:
        return wants_limit(settings, shape.of_arrays(read_mesh(mesh)))

    name = "cage", shape.rows, settings.use_crease_attribute, settings.use_sharp_edges
    return settings.for_source(source, shown(source.data, name, measure, False))
