# SPDX-License-Identifier: GPL-3.0-or-later
"""STEP files read back by Open CASCADE (cadquery-ocp-novtk), where that is installed."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pytest

try:
    import OCP.TopAbs as OCP
except ImportError:
    OCP = None

ABSENT = "Open CASCADE is missing: pip install cadquery-ocp-novtk, as build_tools/requirements.txt"


@dataclass(frozen=True)
class ReadFile:
    """What Open CASCADE has read, measured on demand; lengths in millimetres, to which it converts all units."""

    shape: Any

    @property
    def valid(self) -> bool:
        from OCP.BRepCheck import BRepCheck_Analyzer

        return BRepCheck_Analyzer(self.shape).IsValid()

    @property
    def solids(self) -> int:
        return self._count("SOLID")

    @property
    def shells(self) -> int:
        return self._count("SHELL")

    @property
    def faces(self) -> int:
        return self._count("FACE")

    @property
    def free_edges(self) -> int:
        return self._faces_of_edges.count(1)

    @property
    def tolerance(self) -> float:
        """The farthest that an edge is from its faces and its ends, 1e-7 or more."""
        from OCP.ShapeAnalysis import ShapeAnalysis_ShapeTolerance

        return ShapeAnalysis_ShapeTolerance().Tolerance(self.shape, 1)

    @property
    def volume(self) -> float:
        return self._mass("VolumeProperties_s").Mass()

    @property
    def area(self) -> float:
        return self._mass("SurfaceProperties_s").Mass()

    @property
    def centre(self) -> tuple[float, float, float]:
        """Of the volume."""
        return _coordinates(self._mass("VolumeProperties_s").CentreOfMass())

    @property
    def lowest(self) -> tuple[float, float, float]:
        return _coordinates(self._box.CornerMin())

    @property
    def highest(self) -> tuple[float, float, float]:
        return _coordinates(self._box.CornerMax())

    @cached_property
    def _faces_of_edges(self) -> list[int]:
        """The number of faces at each edge."""
        from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher as ShapeMap
        from OCP.TopExp import TopExp

        edges, kind = ShapeMap(), OCP.TopAbs_ShapeEnum.TopAbs_EDGE
        TopExp.MapShapes_s(self.shape, kind, edges)
        uses = [0] * edges.Extent()
        for edge in parts(self.shape, kind):
            uses[edges.FindIndex(edge) - 1] += 1
        return uses

    @cached_property
    def _box(self) -> Any:
        from OCP.Bnd import Bnd_Box
        from OCP.BRepBndLib import BRepBndLib

        box = Bnd_Box()
        BRepBndLib.AddOptimal_s(self.shape, box)
        return box

    def _count(self, kind: str) -> int:
        return len(list(parts(self.shape, getattr(OCP.TopAbs_ShapeEnum, f"TopAbs_{kind}"))))

    def _mass(self, properties: str) -> Any:
        from OCP.BRepGProp import BRepGProp
        from OCP.GProp import GProp_GProps

        found = GProp_GProps()
        getattr(BRepGProp, properties)(self.shape, found, 1e-9)
        return found


def read(path: Path | str) -> ReadFile:
    """The file at `path`; the test is skipped where Open CASCADE is missing."""
    if OCP is None:
        pytest.skip(ABSENT)
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPControl import STEPControl_Reader

    reader = STEPControl_Reader()
    assert reader.ReadFile(str(path)) == IFSelect_ReturnStatus.IFSelect_RetDone
    reader.TransferRoots()
    return ReadFile(reader.OneShape())


def parts(shape: Any, kind: Any) -> Iterator[Any]:
    """The parts of a shape that are of one kind."""
    from OCP.TopExp import TopExp_Explorer

    explorer = TopExp_Explorer(shape, kind)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def _coordinates(point: Any) -> tuple[float, float, float]:
    return point.X(), point.Y(), point.Z()
