# SPDX-License-Identifier: GPL-3.0-or-later
"""STEP files read back by Open CASCADE (cadquery-ocp-novtk), where that is installed."""

from dataclasses import dataclass
from pathlib import Path

try:
    import OCP.TopAbs as OCP
except ImportError:
    OCP = None

ABSENT = "Open CASCADE is missing: pip install cadquery-ocp-novtk, as build_tools/requirements.txt"


@dataclass(frozen=True)
class ReadFile:
    """What Open CASCADE found; lengths in millimetres, which it converts all units to."""

    valid: bool
    solids: int
    shells: int
    faces: int
    free_edges: int
    shared_edges: int
    volume: float
    area: float


def read(path: Path) -> ReadFile:
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPControl import STEPControl_Reader

    reader = STEPControl_Reader()
    assert reader.ReadFile(str(path)) == IFSelect_ReturnStatus.IFSelect_RetDone
    reader.TransferRoots()
    shape = reader.OneShape()
    kinds = OCP.TopAbs_ShapeEnum
    uses = _faces_of_edges(shape)
    return ReadFile(
        BRepCheck_Analyzer(shape).IsValid(),
        _count(shape, kinds.TopAbs_SOLID),
        _count(shape, kinds.TopAbs_SHELL),
        _count(shape, kinds.TopAbs_FACE),
        sum(count == 1 for count in uses),
        sum(count == 2 for count in uses),
        _measure(shape, "VolumeProperties_s"),
        _measure(shape, "SurfaceProperties_s"),
    )


def _count(shape, kind) -> int:
    from OCP.TopExp import TopExp_Explorer

    explorer, count = TopExp_Explorer(shape, kind), 0
    while explorer.More():
        count += 1
        explorer.Next()
    return count


def _faces_of_edges(shape) -> list[int]:
    """The number of faces at each edge."""
    from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher as ShapeMap
    from OCP.TopExp import TopExp, TopExp_Explorer

    edges = ShapeMap()
    kinds = OCP.TopAbs_ShapeEnum
    TopExp.MapShapes_s(shape, kinds.TopAbs_EDGE, edges)
    uses = [0] * edges.Extent()
    explorer = TopExp_Explorer(shape, kinds.TopAbs_EDGE)
    while explorer.More():
        uses[edges.FindIndex(explorer.Current()) - 1] += 1
        explorer.Next()
    return uses


def _measure(shape, properties: str) -> float:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    found = GProp_GProps()
    getattr(BRepGProp, properties)(shape, found, 1e-9)
    return found.Mass()
