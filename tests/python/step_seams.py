# SPDX-License-Identifier: GPL-3.0-or-later
"""What Open CASCADE finds in a STEP file beside solids and volumes: gaps, borders, names, colours."""

from pathlib import Path

import numpy as np
import step_files

STEPS = 8  # of an edge, between two samples


def gap_and_borders(path: Path) -> tuple[float, np.ndarray]:
    """The farthest an edge is from a rim at it, and middles (f, 3) of edges with one face."""
    from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
    from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher as ShapeMap
    from OCP.TopExp import TopExp
    from OCP.TopoDS import TopoDS

    shape = step_files.read(path).shape
    kinds = step_files.OCP.TopAbs_ShapeEnum
    edges = ShapeMap()
    TopExp.MapShapes_s(shape, kinds.TopAbs_EDGE, edges)
    curves, uses, gap = {}, np.zeros(edges.Extent() + 1, int), 0.0
    for face in step_files.parts(shape, kinds.TopAbs_FACE):
        surface = BRepAdaptor_Surface(TopoDS.Face(face), False)
        for edge in step_files.parts(face, kinds.TopAbs_EDGE):
            number = edges.FindIndex(edge)
            if number not in curves:
                curves[number] = _along(BRepAdaptor_Curve(TopoDS.Edge(edge)))
            uses[number] += 1
            gap = max(gap, _from_rim(surface, curves[number]))
    free = [curves[number][STEPS // 2] for number in np.flatnonzero(uses == 1).tolist()]
    return gap, np.array(free).reshape(-1, 3)


def names_and_colours(path: Path) -> list[tuple[str, list[tuple[float, ...]]]]:
    """For each part its name and the colours of its solid and its faces: red, green and blue as the file has them."""
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
            for item in step_files.parts(shape, kind)
        ]
        shades = [_colour(colours, item) for item in items]
        found.append((name.Get().ToExtString(), [shade for shade in shades if shade]))
    return found


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


def _along(curve) -> np.ndarray:
    """(STEPS + 1, 3)."""
    ends = curve.FirstParameter(), curve.LastParameter()
    return _points(curve.Value(t) for t in np.linspace(*ends, STEPS + 1).tolist())


def _from_rim(surface, edge: np.ndarray) -> float:
    """How far an edge is from the nearest side of a face, from one knot of it to another."""
    spline = surface.BSpline()
    us = [spline.UKnot(k) for k in range(1, spline.NbUKnots() + 1)]
    vs = [spline.VKnot(k) for k in range(1, spline.NbVKnots() + 1)]
    sides = [[(u, v) for u in us] for v in (vs[0], vs[-1])]
    sides += [[(u, v) for v in vs] for u in (us[0], us[-1])]
    found = np.inf
    for side in sides:
        knots = _points(surface.Value(*at) for at in side)
        start, end = (
            side[np.linalg.norm(knots - point, axis=1).argmin()] for point in (edge[0], edge[-1])
        )
        along = np.linspace(start, end, STEPS + 1)
        points = _points(surface.Value(u, v) for u, v in along.tolist())
        found = min(found, np.linalg.norm(points - edge, axis=1).max())
    return found


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
