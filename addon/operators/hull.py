# SPDX-License-Identifier: GPL-3.0-or-later
"""Close Hull: makes a half hull whole and watertight."""

from dataclasses import asdict, replace
from typing import Any, cast

import bpy
import numpy as np

from ..blender import Context, Mesh, Object
from ..errors import JobError
from ..memory import active_source, source_of
from ..mesh.layers import write_creases
from ..mesh.object import new_object, select_only
from ..mesh.offset_names import read_names, write_names
from ..mesh.read import active_mesh, control_mesh, read_mesh
from ..mesh.scans import in_metres, of_mesh
from ..mesh.shape_keys import mixed_positions
from ..poll import IN_OBJECT_MODE, needs
from ..settings import Settings
from ..yard.closing import NotHalf, Whole, whole
from ..yard.hydrostatics import NotClosed, Solid, solid
from .mixins import Action

ACTIVE_MESH = (IN_OBJECT_MODE, needs(active_mesh, "Select a mesh object first"))


class OBJECT_OT_fairing_close(Action, bpy.types.Operator):
    """Make half a hull whole and watertight: mirrored, with a deck and a flat transom between sharp rims"""

    bl_idname = "object.fairing_close"
    bl_label = "Close Hull"

    reasons = ACTIVE_MESH

    def act(self, context: Context) -> str:
        """Closes the control mesh; if its surface is active, fairs the closed one with the same
        settings."""
        active = cast(Object, context.active_object)
        source = cast(Object, active_source(context))
        settings = None if source_of(active) is None else Settings.of(active.discrete_fairing)
        try:
            closed = _closed(context, source)
        except NotHalf as error:
            raise JobError(f"{source.name} is no half hull: {error}.") from error
        except NotClosed as error:
            raise JobError(
                f"Run Check Mesh on {source.name}: {error.args[0]} edges stay open."
            ) from error
        select_only(context, [closed])
        active.hide_set(True)  # the closed hull lies on it
        if settings is not None:
            options = asdict(replace(settings, symmetry_plane="NONE", use_selection=False))
            cast(Any, bpy.ops.object).fairing_surface(**options)
        found = solid(*in_metres(context, cast(Object, context.active_object)))
        return f"Closed: {_solid_text(found)}"


def _closed(context: Context, source: Object) -> Object:
    """A new control mesh beside `source`, with creased rims; raises NotHalf, NotClosed."""
    with control_mesh(context, source) as mesh:
        arrays = read_mesh(mesh)
        names = read_names(mesh)
        places = mixed_positions(source, mesh, arrays.positions)
    made = whole(places, arrays.corners, arrays.offsets)
    mesh = cast(Mesh, bpy.data.meshes.new(f"{source.name} Closed"))
    try:
        faces = np.split(made.corners, made.offsets[1:-1])
        mesh.from_pydata(made.positions.tolist(), [], [face.tolist() for face in faces])
        made_of = of_mesh(mesh)
        if solid(made_of.points, made_of.triangles).volume < 0.0:
            mesh.flip_normals()
    except NotClosed:
        bpy.data.meshes.remove(mesh)
        raise
    weights = (
        {} if arrays.edge_crease is None else dict(zip(_pairs(arrays.edges), arrays.edge_crease))
    )
    _crease(mesh, made, weights)
    if names:
        write_names(mesh, [names[k] for k in made.origin.tolist()])
    return new_object(context, source, mesh)


def _pairs(edges: np.ndarray) -> list[frozenset[int]]:
    return [frozenset(pair) for pair in edges.tolist()]


def _crease(mesh: Mesh, made: Whole, weights: dict[frozenset[int], float]) -> None:
    """Creases rims, and the edges of both sides by the half's own `weights`."""
    wanted = {
        frozenset(edge.vertices): weights.get(
            frozenset(made.origin[list(edge.vertices)].tolist()), 0.0
        )
        for edge in mesh.edges
    }
    wanted |= dict.fromkeys(_pairs(made.rim), 1.0)
    write_creases(mesh, wanted)


def _solid_text(found: Solid) -> str:
    noise = 1e-6 * np.abs(found.centroid).max()
    centre = ", ".join(f"{value if abs(value) > noise else 0:.4g}" for value in found.centroid)
    return f"volume {found.volume:.5g} m³, area {found.area:.5g} m², centroid ({centre}) m"
