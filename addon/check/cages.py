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

REASON = "tight rims, hollows or slits"


def _is_auto(settings: Settings) -> bool:
    """Whether the shape decides. Where folds become sharp, a fold is no rim."""
    return settings.interpolation == "AUTO" and not (
        settings.use_selection or settings.use_crease_angle
    )


def wants_limit(settings: Settings, cage: core.ControlArrays) -> bool:
    """Whether AUTO is LIMIT for the shape of `cage` in the world, none of whose faces are kept flat."""
    if not _is_auto(settings) or cage.has_flats:
        return False
    sharp = np.zeros(len(cage.edges), bool)
    if settings.use_crease_attribute and cage.edge_crease is not None:
        sharp |= cage.edge_crease > 0
    if settings.use_sharp_edges and cage.sharp_edge is not None:
        sharp |= cage.sharp_edge
    return bool(core.module().automatic.wants_limit(core.measured(cage), sharp))


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
