# SPDX-License-Identifier: GPL-3.0-or-later
"""Section Curves, and File > Export > Lines Plan (.dxf)."""

from collections.abc import Iterator
from math import cos, radians, sin
from typing import Any, cast

import bpy
import numpy as np
from bpy.props import StringProperty

from ..blender import Context, Object
from ..cad.settings import METRES
from ..choices import SECTION_PLANES
from ..errors import JobError
from ..fields import choice, length, number, text
from ..inspection.sections import Drawn, cut
from ..memory import active_source
from ..mesh.object import linked_object, select_only
from ..mesh.offset_names import read_names, stations
from ..mesh.scans import of_mesh, with_faces
from ..mesh.world_shape import world_matrix
from ..yard import dxf
from ..yard.plan import Cut, Plane, opened, places, sheet
from .hull import ACTIVE_MESH
from .mixins import Action, Shown
from .written_files import WritesText, write_text_file

_AXES = {"STATIONS": 0, "BUTTOCKS": 1, "WATERLINES": 2}
_WORDS = {"STATIONS": "station", "BUTTOCKS": "buttock", "WATERLINES": "waterline"}


def _surface(context: Context, target: Object) -> Drawn:
    """The mesh as displayed, in the world, without normals, which would divide it at sharp edges."""
    points, triangles = with_faces(context, target)
    return Drawn(points, np.zeros_like(points), triangles)


def _imported_stations(context: Context) -> list[tuple[str, float]]:
    """The stations of the table of offsets from which the active mesh, or its source, was made."""
    source = cast(Object, active_source(context))
    names = read_names(source.data)
    if not names:
        return []
    placed = of_mesh(source.data).moved(np.array(world_matrix(cast(Object, context.active_object))))
    return stations(names, placed.points[:, 0])


def even_planes(
    context: Context, kind: str, surface: Drawn, listed: str, spacing: float, start: float
) -> list[Plane]:
    """Listed planes, else imported stations, else even ones; ValueError for a bad list."""
    axis = _AXES[kind]
    normal = tuple(float(k == axis) for k in range(3))
    low, high = surface.points[:, axis].min(), surface.points[:, axis].max()
    named = [] if listed.strip() or axis else _imported_stations(context)
    if not named:
        even = places(listed, low, high, spacing, start)
        named = [(f"{_WORDS[kind]} {at:.6g}", at) for at in even]
    inset = 1e-5 * (high - low)  # the end stations are borders, which a plane only touches
    if axis == 1 and abs(low) <= inset and not listed.strip():
        named = [("profile", 0.0), *named]  # of a half hull
    return [
        Plane(name, cast(Any, normal), float(np.clip(at, low + inset, high - inset)))
        for name, at in named
        if low - inset <= at <= high + inset
    ]


def cuts(surface: Drawn, planes: list[Plane]) -> list[Cut]:
    """The cuts that are not empty."""
    found = [Cut(plane, cut(surface, np.array(plane.normal), plane.place)) for plane in planes]
    return [one for one in found if one.curves]


class _Spaced:
    spacing: length(
        "Spacing", "Between planes, if none are listed; 0: five to ten planes at round places"
    )
    start: number("Start", "Where one of the evenly spaced planes is", subtype="DISTANCE")


class OBJECT_OT_fairing_section_curves(Shown, _Spaced, Action, bpy.types.Operator):
    """Make curves where planes cut the active mesh: stations, buttocks, waterlines, diagonals, or your own plane"""

    bl_idname = "object.fairing_section_curves"
    bl_label = "Section Curves"

    kind: choice("Planes", "Which planes cut the mesh", SECTION_PLANES)
    places: text(
        "Places",
        "Where planes cut, such as 0, 1.5, 3, in scene units; empty: by Spacing and Start",
    )
    angle: number(
        "Angle",
        "How far diagonals are tilted from level",
        radians(45.0),
        min=radians(1.0),
        max=radians(89.0),
        subtype="ANGLE",
    )

    reasons = ACTIVE_MESH

    def shown(self, _context: Context) -> Iterator[str]:
        yield "kind"
        if self.kind != "OBJECT":
            yield from ("places", "spacing", "start")
        if self.kind == "DIAGONALS":
            yield "angle"

    def act(self, context: Context) -> str:
        target = cast(Object, context.active_object)
        surface = _surface(context, target)
        try:
            planes = self._planes(context, surface)
        except ValueError as error:
            raise JobError(
                f"Write Places as numbers, such as 0, 1.5, 3: '{self.places}' is no list"
            ) from error
        found = cuts(surface, planes)
        if not found:
            raise JobError("Move the planes, or give a smaller Spacing: none cuts the mesh")
        select_only(context, [_curve_object(context, target, one) for one in found])
        return f"{len(found)} sections of {target.name}"

    def _planes(self, context: Context, surface: Drawn) -> list[Plane]:
        if self.kind == "OBJECT":
            active = context.active_object
            others = [o for o in context.selected_objects if o != active]
            if not others:
                raise JobError(
                    "Select the object whose Z axis the plane is to cross, then the mesh"
                )
            matrices = [(o.name, np.array(o.matrix_world)) for o in others]
            normals = [(n, m[:3, 2] / np.linalg.norm(m[:3, 2]), m[:3, 3]) for n, m in matrices]
            return [Plane(n, tuple(z.tolist()), float(z @ at)) for n, z, at in normals]
        if self.kind == "DIAGONALS":
            normal = (0.0, sin(self.angle), cos(self.angle))
            along = surface.points @ np.array(normal)
            heights = places(
                self.places,
                along.min() / normal[2],
                along.max() / normal[2],
                self.spacing,
                self.start,
            )
            return [Plane(f"diagonal {at:.6g}", normal, at * normal[2]) for at in heights]
        return even_planes(context, self.kind, surface, self.places, self.spacing, self.start)


def _curve_object(context: Context, target: Object, one: Cut) -> Object:
    curve = bpy.data.curves.new(f"{target.name} {one.plane.name}", "CURVE")
    curve.dimensions = "3D"
    for whole in one.curves:
        points, closed = opened(whole)
        spline = curve.splines.new("POLY")
        spline.points.add(len(points) - 1)
        spline.points.foreach_set(
            "co", np.c_[points, np.ones(len(points))].astype(np.float32).ravel()
        )
        spline.use_cyclic_u = closed
    return linked_object(context, curve, target)


class EXPORT_SCENE_OT_fairing_lines(_Spaced, WritesText, bpy.types.Operator):
    """Export stations, buttocks and waterlines of the active mesh with a body plan, as a drawing (DXF)"""

    bl_idname = "export_scene.fairing_lines"
    bl_label = "Export Lines Plan"
    bl_options = {"REGISTER", "PRESET"}
    filename_ext = ".dxf"

    filter_glob: StringProperty(default="*.dxf", options={"HIDDEN"})
    stations: text(
        "Stations",
        "Where stations are, such as 0, 1.5, 3; empty: those of the imported table, else by Spacing",
    )
    scale: number(
        "Scale 1 :",
        "How many times smaller the drawing is than the hull",
        1.0,
        min=1e-3,
        soft_max=100.0,
    )
    unit: choice(
        "Unit",
        "Length of one unit of the drawing",
        [(key, key.lower(), f"One unit is one {key.lower()}") for key in METRES],
    )
    reasons = ACTIVE_MESH

    def act(self, context: Context) -> str:
        target = cast(Object, context.active_object)
        surface = _surface(context, target)
        try:
            given = {kind: self.stations if kind == "STATIONS" else "" for kind in _AXES}
            listed = {
                kind: even_planes(context, kind, surface, said, self.spacing, self.start)
                for kind, said in given.items()
            }
        except ValueError as error:
            raise JobError(
                f"Write Stations as numbers, such as 0, 1.5, 3: '{self.stations}' is no list"
            ) from error
        factor = context.scene.unit_settings.scale_length / METRES[self.unit] / self.scale
        found = {
            kind: [one.scaled(factor) for one in cuts(surface, planes)]
            for kind, planes in listed.items()
        }
        if not any(found.values()):
            raise JobError("Select the surface of a hull: no plane cuts this mesh")
        title = f"{target.name}   1 : {self.scale:g}   {self.unit.lower()}"
        write_text_file(self.filepath, dxf.text(sheet(title, *found.values())))
        count = ", ".join(f"{len(cuts)} {kind.lower()}" for kind, cuts in found.items())
        return f"{count} written to {bpy.path.abspath(self.filepath)}"
