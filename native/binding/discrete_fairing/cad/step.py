# SPDX-License-Identifier: GPL-3.0-or-later
"""write_step(): spline patches as a STEP file (ISO 10303-21, AP214), which every CAD system reads."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..converters import choice
from ..whole_files import file_name, whole_file
from .files import UNITS, Part, cad_parts
from .flat_polygons import Step, outline
from .patches import SplinePatches

# Units as entities of the file.
_WRITTEN = {"m": "$", "cm": ".CENTI.", "mm": ".MILLI.", "in": "INCH", "ft": "FOOT"}


def write_step(
    path: str | os.PathLike,
    patches: SplinePatches | Sequence[SplinePatches],
    *,
    unit: str = "m",
    scale: float = 1.0,
    names: str | Sequence[str] | None = None,
    colours: ArrayLike | Sequence[ArrayLike | None] | None = None,
) -> None:
    """Write patches to a STEP file: a solid for each closed shell, a shell for each open one.

    Parameters
    ----------
    path
        The file, replaced only once the new one is complete.
    patches : SplinePatches, or a list of them
        What fit_patches() returned; each becomes a part of its own.
    unit : "m", "cm", "mm", "in" or "ft"
        The unit of the coordinates in the file.
    scale : float
        What coordinates are multiplied by: how many units a mesh unit has.
    names : str, or a list of them, one a part
        Names of the parts; any characters.
    colours : (3,) float from 0 to 1, or a list, one a part
        Red, green and blue of each part; (P, 3) colours its patches one by one, None leaves it.

    Raises FairingError BAD_OPTION, and OSError where the file cannot be written.
    """
    choice(UNITS)("unit", unit)
    parts = cad_parts(patches, scale, names, colours)
    name = file_name(path)
    with (
        whole_file(name) as place,
        place.open("w", encoding="ascii", newline="\n") as file,
    ):
        writer = _Writer(file, unit)
        writer.header(Path(name).name)
        for part in parts:
            writer.part(part)
        writer.end()


def step_text(text: str) -> str:
    """A string of a STEP file, in ASCII; some programs end it at a doubled apostrophe."""
    out = []
    for character in text:
        if character == "\\":
            out.append(2 * character)
        elif character == "'":
            out.append("\\X2\\0027\\X0\\")
        elif " " <= character <= "~":
            out.append(character)
        elif ord(character) < 0x10000:
            out.append(f"\\X2\\{ord(character):04X}\\X0\\")
        else:
            out.append(f"\\X4\\{ord(character):08X}\\X0\\")
    return "'" + "".join(out) + "'"


def step_real(value: float) -> str:
    """The shortest decimal that reads back as the same number."""
    mantissa, _, exponent = repr(float(value)).partition("e")
    if "." not in mantissa:
        mantissa += "."
    return f"{mantissa}E{int(exponent)}" if exponent else mantissa


def _ids(numbers: Iterable[int]) -> str:
    return "(" + ",".join(f"#{number}" for number in numbers) + ")"


def _flag(value: bool) -> str:
    return ".T." if value else ".F."


class _Writer:
    """Writes entities one after another, and keeps only their numbers."""

    def __init__(self, file: IO[str], unit: str):
        self._file = file
        self._unit = unit
        self._last = 0

    def header(self, name: str) -> None:
        now = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%S")
        system = step_text(f"Discrete Fairing {_native.__version__}")
        self._file.write(
            "ISO-10303-21;\nHEADER;\n"
            "FILE_DESCRIPTION(('fair surface as B-spline patches'),'2;1');\n"
            f"FILE_NAME({step_text(name)},'{now}',(''),(''),{system},{system},'');\n"
            "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\n"
            "ENDSEC;\nDATA;\n"
        )
        application = self._add(
            "APPLICATION_CONTEXT('core data for automotive mechanical design processes')"
        )
        self._add(
            "APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,"
            f"#{application})"
        )
        self._product_context = self._add(f"PRODUCT_CONTEXT('',#{application},'mechanical')")
        self._definition_context = self._add(
            f"PRODUCT_DEFINITION_CONTEXT('part definition',#{application},'design')"
        )
        origin = self._add("CARTESIAN_POINT('',(0.,0.,0.))")
        z = self._add("DIRECTION('',(0.,0.,1.))")
        x = self._add("DIRECTION('',(1.,0.,0.))")
        self._axes = self._add(f"AXIS2_PLACEMENT_3D('',#{origin},#{z},#{x})")
        self._length = self._length_unit()
        self._angle = self._add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
        self._solid_angle = self._add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")

    def end(self) -> None:
        self._file.write("ENDSEC;\nEND-ISO-10303-21;\n")

    def part(self, part: Part) -> None:
        patches, colours = part.patches, part.colours
        title = step_text(part.name)
        context = self._context(patches)
        points = [self._add(f"VERTEX_POINT('',#{self._point(at)})") for at in patches.vertices]
        edges = self._edges(patches, points)
        outward = _outward(patches)
        shells: list[list[int]] = [[] for _ in patches.shell_closed]
        faces = []
        for p in patches.written.tolist():
            shell = patches.patch_shell[p]
            face = self._face if patches.patch_plane[p] < 0 else self._flat_face
            faces.append(face(patches, p, edges, bool(outward[shell])))
            shells[shell].append(faces[-1])
        items = [
            self._shell(title, shell, bool(closed))
            for shell, closed in zip(shells, patches.shell_closed)
        ]
        self._product(title, context, items, patches.shell_closed)
        if colours is not None:
            if colours.ndim > 1:
                items, colours = faces, colours[patches.written]
            self._colour(context, items, np.broadcast_to(colours, (len(items), 3)))

    def _add(self, entity: str) -> int:
        self._last += 1
        self._file.write(f"#{self._last}={entity};\n")
        return self._last

    def _length_unit(self) -> int:
        prefix, metres = _WRITTEN[self._unit], UNITS[self._unit]
        if not prefix.isalpha():
            return self._add(f"(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT({prefix},.METRE.))")
        metre = self._add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))")
        measure = self._add(
            f"LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE({step_real(metres)}),#{metre})"
        )
        size = self._add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)")
        return self._add(
            f"(CONVERSION_BASED_UNIT('{prefix}',#{measure})LENGTH_UNIT()NAMED_UNIT(#{size}))"
        )

    def _context(self, patches: SplinePatches) -> int:
        # edges and patches agree to rounding; programs that read the file use this as their tolerance
        accuracy = min(max(1e-9 * patches.size, 1e-300), 1e300)
        uncertainty = self._add(
            f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({step_real(accuracy)}),#{self._length},"
            "'distance_accuracy_value','')"
        )
        return self._add(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)"
            f"GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{uncertainty}))"
            f"GLOBAL_UNIT_ASSIGNED_CONTEXT((#{self._length},#{self._angle},#{self._solid_angle}))"
            "REPRESENTATION_CONTEXT('',''))"
        )

    def _point(self, at: np.ndarray) -> int:
        x, y, z = (step_real(value) for value in at.tolist())
        return self._add(f"CARTESIAN_POINT('',({x},{y},{z}))")

    def _edges(self, patches: SplinePatches, points: list[int]) -> list[int]:
        out = []
        for e, (spans, (start, end)) in enumerate(
            zip(patches.edge_spans.tolist(), patches.edge_vertices.tolist())
        ):
            controls = _ids([self._point(at) for at in patches.edge(e)])
            curve = self._add(
                f"B_SPLINE_CURVE_WITH_KNOTS('',3,{controls},.UNSPECIFIED.,.F.,.F.,"
                f"{_multiplicities(spans)},{_knots(spans)},.UNSPECIFIED.)"
            )
            out.append(self._add(f"EDGE_CURVE('',#{points[start]},#{points[end]},#{curve},.T.)"))
        return out

    def _face(self, patches: SplinePatches, p: int, edges: list[int], outward: bool) -> int:
        rows = [_ids([self._point(at) for at in row]) for row in patches.net(p)]
        u, v = patches.patch_spans[p].tolist()
        surface = self._add(
            f"B_SPLINE_SURFACE_WITH_KNOTS('',3,3,({','.join(rows)}),.UNSPECIFIED.,.F.,.F.,.F.,"
            f"{_multiplicities(u)},{_multiplicities(v)},{_knots(u)},{_knots(v)},.UNSPECIFIED.)"
        )
        return self._bounded(surface, patches.loop(p), edges, outward)

    def _flat_face(self, patches: SplinePatches, p: int, edges: list[int], outward: bool) -> int:
        """The face of all patches in the plane of p."""
        own = np.flatnonzero(patches.patch_plane == patches.patch_plane[p])
        steps = [step for patch in own for step in patches.loop(patch)]
        used, forward = map(np.array, zip(*steps))
        loop = outline(used, forward, patches.edge_vertices)
        line = np.concatenate([patches.edge(e)[:: 1 if on else -1][:-1] for e, on in loop])
        arms = (line - line[0]) / np.abs(line - line[0]).max()  # so that squares do not overflow
        normal = np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0)
        normal /= np.linalg.norm(normal)
        along = arms[1]
        along -= along @ normal * normal
        origin, axes = self._point(line[0]), [self._direction(v) for v in (normal, along)]
        place = self._add(f"AXIS2_PLACEMENT_3D('',#{origin},#{axes[0]},#{axes[1]})")
        return self._bounded(self._add(f"PLANE('',#{place})"), loop, edges, outward)

    def _direction(self, along: np.ndarray) -> int:
        x, y, z = (step_real(value) for value in (along / np.linalg.norm(along)).tolist())
        return self._add(f"DIRECTION('',({x},{y},{z}))")

    def _bounded(self, surface: int, loop: list[Step], edges: list[int], outward: bool) -> int:
        if not outward:
            loop = [(e, not on) for e, on in loop[::-1]]
        oriented = [self._add(f"ORIENTED_EDGE('',*,*,#{edges[e]},{_flag(on)})") for e, on in loop]
        around = self._add(f"EDGE_LOOP('',{_ids(oriented)})")
        bound = self._add(f"FACE_OUTER_BOUND('',#{around},.T.)")
        return self._add(f"ADVANCED_FACE('',(#{bound}),#{surface},{_flag(outward)})")

    def _shell(self, title: str, faces: list[int], closed: bool) -> int:
        kind = "CLOSED_SHELL" if closed else "OPEN_SHELL"
        shell = self._add(f"{kind}('',{_ids(faces)})")
        if closed:
            return self._add(f"MANIFOLD_SOLID_BREP({title},#{shell})")
        return self._add(f"SHELL_BASED_SURFACE_MODEL({title},(#{shell}))")

    def _product(self, title: str, context: int, items: list[int], closed: np.ndarray) -> None:
        product = self._add(f"PRODUCT({title},{title},'',(#{self._product_context}))")
        self._add(f"PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(#{product}))")
        formation = self._add(f"PRODUCT_DEFINITION_FORMATION('','',#{product})")
        definition = self._add(
            f"PRODUCT_DEFINITION('design','',#{formation},#{self._definition_context})"
        )
        shape = self._add(f"PRODUCT_DEFINITION_SHAPE('','',#{definition})")
        kind = "SHAPE_REPRESENTATION"
        if closed.all():
            kind = "ADVANCED_BREP_SHAPE_REPRESENTATION"
        elif not closed.any():
            kind = "MANIFOLD_SURFACE_SHAPE_REPRESENTATION"
        of = self._add(f"{kind}({title},{_ids([self._axes, *items])},#{context})")
        self._add(f"SHAPE_DEFINITION_REPRESENTATION(#{shape},#{of})")

    def _colour(self, context: int, items: list[int], colours: np.ndarray) -> None:
        styles: dict[tuple[float, ...], int] = {}
        styled = []
        for item, colour in zip(items, map(tuple, colours.tolist())):
            if colour not in styles:
                styles[colour] = self._style(colour)
            styled.append(self._add(f"STYLED_ITEM('',(#{styles[colour]}),#{item})"))
        self._add(
            f"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',{_ids(styled)},#{context})"
        )

    def _style(self, colour: tuple[float, ...]) -> int:
        values = ",".join(map(step_real, colour))
        last = self._add(f"COLOUR_RGB('',{values})")
        for entity in (
            "FILL_AREA_STYLE_COLOUR('',#{})",
            "FILL_AREA_STYLE('',(#{}))",
            "SURFACE_STYLE_FILL_AREA(#{})",
            "SURFACE_SIDE_STYLE('',(#{}))",
            "SURFACE_STYLE_USAGE(.BOTH.,#{})",
            "PRESENTATION_STYLE_ASSIGNMENT((#{}))",
        ):
            last = self._add(entity.format(last))
        return last


def _outward(patches: SplinePatches) -> np.ndarray:
    """(S,) bool: false for closed shells oriented inwards; a solid's faces must be oriented outwards."""
    volume = np.zeros(len(patches.shell_closed))
    extent = np.abs(patches.vertices - patches.vertices[:1]).max(initial=0) or 1.0
    for p in range(len(patches)):
        # scaled, so that cubes do not overflow
        net = (patches.net(p) - patches.vertices[0]) / extent
        a, b, c, d = net[:-1, :-1], net[1:, :-1], net[1:, 1:], net[:-1, 1:]
        cells = np.cross(a, b) * c + np.cross(a, c) * d
        volume[patches.patch_shell[p]] += cells.sum()
    return ~patches.shell_closed | (volume >= 0)


def _multiplicities(spans: int) -> str:
    return "(4," + "1," * (spans - 1) + "4)"


def _knots(spans: int) -> str:
    return "(" + ",".join(step_real(k / spans) for k in range(spans + 1)) + ")"
