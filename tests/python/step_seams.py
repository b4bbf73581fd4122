# SPDX-License-Identifier: GPL-3.0-or-later
"""What Open CASCADE finds in a STEP file beside solids and volumes: gaps, borders, names, colours."""

from pathlib import Path

import numpy as np
import step_files

STEPS = (
    16  # of a side, between two samples; edges have whole sides or halves, and half of the steps
)


def gap_and_borders(path: Path) -> tuple[float, np.ndarray]:
    """The farthest that an edge is from the rim of a face at it, and (f, 3) the middles of the edges
    with one face only; in the file's unit times its millimetres.
    """
    from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
    from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher as ShapeMap
    from OCP.TopExp import TopExp
    from OCP.TopoDS import TopoDS

    shape = _shape(path)
    kinds = step_files.OCP.TopAbs_ShapeEnum
    edges = ShapeMap()
    TopExp.MapShapes_s(shape, kinds.TopAbs_EDGE, edges)
    curves, uses, gap = {}, np.zeros(edges.Extent() + 1, int), 0.0
    for face in _parts(shape, kinds.TopAbs_FACE):
        rim = _rim(BRepAdaptor_Surface(TopoDS.Face(face), False))
        for edge in _parts(face, kinds.TopAbs_EDGE):
            number = edges.FindIndex(edge)
            if number not in curves:
                curves[number] = _along(BRepAdaptor_Curve(TopoDS.Edge(edge)))
            uses[number] += 1
            far = np.linalg.norm(rim - curves[number], axis=2).max(axis=1)
            gap = max(gap, far.min())
    free = [curves[number][STEPS // 4] for number in np.flatnonzero(uses == 1).tolist()]
    return gap, np.array(free).reshape(-1, 3)


def names_and_colours(path: Path) -> list[tuple[str, list[tuple[float, ...]]]]:
    """Of each part its name, and what its solid and its faces are coloured with, red, green and blue
    as the file has them.
    """
    from OCP.collections import Sequence_TDF_Label
    from OCP.TDataStd import TDataStd_Name
    from OCP.XCAFDoc import XCAFDoc_DocumentTool

    kinds = step_files.OCP.TopAbs_ShapeEnum
    document = _document(path)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    labels, found = Sequence_TDF_Label(), []
    shapes.GetFreeShapes(labels)
    for k in range(1, labels.Length() + 1):
        name = TDataStd_Name()
        assert labels.Value(k).FindAttribute(TDataStd_Name.GetID_s(), name)
        shape = shapes.GetShape_s(labels.Value(k))
        items = [
            item
            for kind in (kinds.TopAbs_SOLID, kinds.TopAbs_SHELL, kinds.TopAbs_FACE)
            for item in _parts(shape, kind)
        ]
        shades = [_colour(colours, item) for item in items]
        found.append((name.Get().ToExtString(), [shade for shade in shades if shade]))
    return found


def _shape(path: Path):
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPControl import STEPControl_Reader

    reader = STEPControl_Reader()
    assert reader.ReadFile(str(path)) == IFSelect_ReturnStatus.IFSelect_RetDone
    reader.TransferRoots()
    return reader.OneShape()


def _document(path: Path):
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPCAFControl import STEPCAFControl_Reader
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDocStd import TDocStd_Document

    document = TDocStd_Document(TCollection_ExtendedString("file"))
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    assert reader.ReadFile(str(path)) == IFSelect_ReturnStatus.IFSelect_RetDone
    assert reader.Transfer(document)
    return document


def _parts(shape, kind):
    from OCP.TopExp import TopExp_Explorer

    explorer = TopExp_Explorer(shape, kind)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def _along(curve) -> np.ndarray:
    """(STEPS // 2 + 1, 3)."""
    ends = curve.FirstParameter(), curve.LastParameter()
    return _points(curve.Value(t) for t in np.linspace(*ends, STEPS // 2 + 1).tolist())


def _rim(surface) -> np.ndarray:
    """(24, STEPS // 2 + 1, 3): the sides of a face and their halves, both ways."""
    low_u, high_u = surface.FirstUParameter(), surface.LastUParameter()
    low_v, high_v = surface.FirstVParameter(), surface.LastVParameter()
    us, vs = (np.linspace(*ends, STEPS + 1).tolist() for ends in ((low_u, high_u), (low_v, high_v)))
    sides = [_points(surface.Value(u, v) for u in us) for v in (low_v, high_v)]
    sides += [_points(surface.Value(u, v) for v in vs) for u in (low_u, high_u)]
    half = STEPS // 2
    ways = [way for side in sides for way in (side[::2], side[: half + 1], side[half:])]
    return np.array([way[::turn] for way in ways for turn in (1, -1)])


def _points(found) -> np.ndarray:
    return np.array([(point.X(), point.Y(), point.Z()) for point in found])


def _colour(colours, shape) -> tuple[float, ...] | None:
    from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
    from OCP.XCAFDoc import XCAFDoc_ColorType

    found = Quantity_Color()
    if not colours.GetColor(shape, XCAFDoc_ColorType.XCAFDoc_ColorSurf, found):
        return None
    values = found.Values(Quantity_TypeOfColor.Quantity_TOC_sRGB)
    return tuple(round(value, 4) for value in values)
