# SPDX-License-Identifier: GPL-3.0-or-later
"""Close Hull: makes a half hull whole and watertight. Hydrostatics at its draught, as a report or table."""

from collections.abc import Iterable
from dataclasses import asdict, replace
from itertools import compress
from math import degrees, radians
from typing import Any, cast

import bpy
import numpy as np
from bpy.props import StringProperty

from ..blender import Context, Mesh, Object
from ..errors import JobError
from ..fields import length, number, whole
from ..memory import active_source, source_of
from ..mesh.layers import write_creases
from ..mesh.object import new_object, select_only
from ..mesh.offset_names import read_names, write_names
from ..mesh.read import active_mesh, control_mesh, read_mesh
from ..mesh.scans import in_metres, of_mesh
from ..mesh.shape_keys import mixed_positions
from ..poll import IN_OBJECT_MODE, needs
from ..settings import Settings
from ..yard.closing import NotHalf, Whole, whole_hull
from ..yard.halves import sharp_in_middle
from ..yard.hydrostatics import Hydrostatics, NotClosed, Solid, hydrostatics, solid
from .mixins import Action, Shown
from .written_files import WritesText, write_text_file

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
            closed = _closed(context, source, settings)
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


def _closed(context: Context, source: Object, settings: Settings | None) -> Object:
    """A new control mesh beside `source`, with creased rims, and where the halves of a surface with these `settings`
    meet at an angle; raises NotHalf, NotClosed.
    """
    with control_mesh(context, source) as mesh:
        arrays = read_mesh(mesh)
        names = read_names(mesh)
        places = mixed_positions(source, mesh, arrays.positions)
    made = whole_hull(places, arrays.corners, arrays.offsets)
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
    if settings is not None and settings.symmetry_plane == "NONE":
        middle, sharp, _ = sharp_in_middle(arrays, "Y", settings)
        weights |= dict.fromkeys(compress(middle, sharp), 1.0)
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


class _Afloat(Action):
    """x is along the hull, z up; the draught is measured from the lowest point at no trim."""

    reasons = ACTIVE_MESH

    draught: length(
        "Draught",
        "Waterplane above the lowest point of the hull, in the middle of its length; 0: half its height",
    )
    trim: number(
        "Trim",
        "How far the waterplane is tilted: it rises with X",
        soft_min=radians(-10.0),
        soft_max=radians(10.0),
        subtype="ANGLE",
    )
    density: number(
        "Density",
        "Kilograms per cubic metre: 1025 in the sea, 1000 in fresh water",
        1025.0,
        min=0.0,
    )

    def afloat(self, context: Context, count: int) -> dict[float, Hydrostatics]:
        """The hydrostatics at `count` even draughts, in metres, up to the draught; raises JobError."""
        target = cast(Object, context.active_object)
        points, triangles = in_metres(context, target)
        low, height = points[:, 2].min(), np.ptp(points[:, 2])
        pivot = 0.5 * (points[:, 0].min() + points[:, 0].max())
        deepest = self.draught * context.scene.unit_settings.scale_length or 0.5 * height
        try:
            found = {
                draught: hydrostatics(points, triangles, low + draught, self.trim, pivot)
                for draught in (deepest * (k + 1) / count for k in range(count))
            }
        except NotClosed as error:
            raise JobError(
                f"Press Close Hull, or fill holes: {target.name} has {error.args[0]} open edges below the waterplane."
            ) from error
        if not all(one.length for one in found.values()):
            raise JobError(
                f"Set Draught below {height:.4g} m: the waterplane does not cross {target.name}."
            )
        return found


class OBJECT_OT_fairing_hydrostatics(Shown, _Afloat, bpy.types.Operator):
    """Measure displacement, centres, wetted surface and waterplane of a hull at a draught and trim"""

    bl_idname = "object.fairing_hydrostatics"
    bl_label = "Hydrostatics"

    said: StringProperty(options={"HIDDEN", "SKIP_SAVE"})

    def act(self, context: Context) -> str:
        ((draught, found),) = self.afloat(context, 1).items()
        if found.beam > found.length:
            self.report({"WARNING"}, "Turn the hull, unless it is wider than long: X is along it")
        lines = [
            f"Draught {draught:.4g} m: displacement {found.volume * self.density:,.5g} kg, {found.volume:.5g} m³",
            f"LCB {found.buoyancy[0]:.4g} m, VCB {found.buoyancy[2]:.4g} m",
            f"Wetted surface {found.wetted:.5g} m²",
            f"Waterplane {found.waterplane:.5g} m², LCF {found.flotation:.4g} m",
            f"BM {found.metacentre:.4g} m, block coefficient {found.block_coefficient(draught):.3g}",
        ]
        self.said = "\n".join(lines)
        return ", ".join(lines)

    def shown(self, _context: Context) -> Iterable[str]:
        return _Afloat.__annotations__

    def draw(self, context: Context) -> None:
        super().draw(context)
        column = cast(bpy.types.UILayout, self.layout).box().column(align=True)
        for line in self.said.split("\n"):
            column.label(text=line)


class OBJECT_OT_fairing_hydrostatics_table(_Afloat, WritesText, bpy.types.Operator):
    """Write hydrostatics at evenly spaced draughts as a table (CSV), in metres and kilograms"""

    bl_idname = "object.fairing_hydrostatics_table"
    bl_label = "Table of Hydrostatics (CSV)"
    bl_options = {"REGISTER"}
    filename_ext = ".csv"

    filter_glob: StringProperty(default="*.csv", options={"HIDDEN"})
    count: whole("Draughts", "How many, up to the draught", 10, min=1, soft_max=50)

    def act(self, context: Context) -> str:
        rows = [self._row(one, at) for at, one in self.afloat(context, self.count).items()]
        lines = [",".join(f"{number:.9g}" for number in row.values()) for row in rows]
        write_text_file(self.filepath, "\r\n".join([",".join(rows[0]), *lines, ""]))
        return f"{len(rows)} draughts written to {bpy.path.abspath(self.filepath)}"

    def _row(self, found: Hydrostatics, draught: float) -> dict[str, float]:
        return {
            "draught_m": draught,
            "trim_deg": degrees(self.trim),
            "volume_m3": found.volume,
            "displacement_kg": found.volume * self.density,
            "lcb_m": found.buoyancy[0],
            "vcb_m": found.buoyancy[2],
            "wetted_m2": found.wetted,
            "waterplane_m2": found.waterplane,
            "lcf_m": found.flotation,
            "bm_m": found.metacentre,
            "length_m": found.length,
            "beam_m": found.beam,
            "block_coefficient": found.block_coefficient(draught),
        }
