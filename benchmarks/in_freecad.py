# SPDX-License-Identifier: GPL-3.0-or-later
"""Operations of FreeCAD on STEP files: sections, a cut with a box, parallel surfaces.

    DF_STEP_FILES=FOLDER freecadcmd benchmarks/in_freecad.py

Prints a row a file: solids, whether the shape is valid, its volume, and for each operation whether
the outcome is valid, with its area or volume. The box is an octant around the middle; the surfaces
are moved outwards by 0.01 of the size.
"""

import os
import time
from pathlib import Path

import FreeCAD
import Part

OFFSET = 0.01  # of the size


def section(shape, middle, _size):
    """The area of the section at the middle height."""
    wires = shape.slice(FreeCAD.Vector(0, 0, 1), middle.z)
    if not all(wire.isClosed() for wire in wires):
        return "open", sum(wire.Length for wire in wires)
    faces = Part.makeFace(wires, "Part::FaceMakerBullseye")
    return faces.isValid(), faces.Area


def cut(shape, middle, size):
    """The volume after an octant is cut away."""
    rest = shape.cut(Part.makeBox(size, size, size, middle))
    return rest.isValid(), rest.Volume


def offset(shape, _middle, size):
    """The volume inside the outer parallel surface."""
    moved = shape.makeOffsetShape(OFFSET * size, 1e-4 * size)
    return moved.isValid(), moved.Volume


def attempt(operation, *arguments):
    """Validity, figure and seconds of an operation, as text."""
    start = time.perf_counter()
    try:
        valid, figure = operation(*arguments)
    except Exception as error:  # FreeCAD has types of its own, with long texts
        return type(error).__name__
    return f"{valid}, {figure:.9g}, {time.perf_counter() - start:.1f} s"


def row(path):
    """The row of one file."""
    shape = Part.Shape()
    shape.read(str(path))
    if len(shape.Solids) == 1:
        shape = shape.Solids[0]
    box = shape.BoundBox
    size = max(box.XLength, box.YLength, box.ZLength)
    cells = [path.stem, len(shape.Solids), shape.isValid(), f"{shape.Volume:.9g}"]
    cells += [attempt(operation, shape, box.Center, size) for operation in (section, cut, offset)]
    return "| " + " | ".join(map(str, cells)) + " |"


for file in sorted(Path(os.environ["DF_STEP_FILES"]).glob("*.step")):
    print(row(file), flush=True)
