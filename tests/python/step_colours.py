# SPDX-License-Identifier: GPL-3.0-or-later
"""Names and colours that Open CASCADE finds in a STEP file."""

from pathlib import Path

import step_files


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


def _colour(colours, shape) -> tuple[float, ...] | None:
    from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
    from OCP.XCAFDoc import XCAFDoc_ColorType

    found = Quantity_Color()
    if not colours.GetColor(shape, XCAFDoc_ColorType.XCAFDoc_ColorSurf, found):
        return None
    values = found.Values(Quantity_TypeOfColor.Quantity_TOC_sRGB)
    return tuple(round(value, 4) for value in values)
