# SPDX-License-Identifier: GPL-3.0-or-later
"""Cages that are better served with flats kept, or by Subdivision Surface, known by their shape."""

from .. import core
from ..blender import Mesh, Object
from ..mesh.mesh_changes import shown
from ..mesh.read import read_mesh
from ..mesh.world_shape import world_shape
from ..properties import FairingSettings
from ..settings import Settings, is_evaluated, subdivision

# the shape that decides, by what AUTO is
REASONS = {"LIMIT": "tight rims, hollows or slits", "FLATS": "flats and walls between tight rims"}
NOTES = {
    "LIMIT": f"Passes where Subdivision Surface would (Limit), for its {REASONS['LIMIT']}.",
    "FLATS": f"Keeps its {REASONS['FLATS']} as they are (Flats).",
}


def _is_auto(settings: Settings) -> bool:
    """Whether the shape decides. Where folds become sharp, a fold is no rim."""
    return settings.interpolation == "AUTO" and not (
        settings.use_selection or settings.use_crease_angle
    )


def choice(settings: Settings, cage: core.ControlArrays) -> str:
    """What AUTO is for the shape of `cage` in the world: EXACT, FLATS or LIMIT. Marked flats decide for EXACT."""
    if not _is_auto(settings) or cage.has_flats:
        return "EXACT"
    mesh, sharp = core.measured(cage), core.sharp_edges(cage, settings)
    found = core.module().automatic.choice(mesh, sharp, core.keeps_marks(settings))
    return str(found).upper()


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

    def measure(mesh: Mesh) -> str:
        return choice(settings, shape.of_arrays(read_mesh(mesh)))

    marks = settings.use_crease_attribute, settings.use_sharp_edges, core.keeps_marks(settings)
    name = "cage", shape.rows, *marks
    return settings.for_source(source, shown(source.data, name, measure, "EXACT"))
