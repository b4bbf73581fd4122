# SPDX-License-Identifier: GPL-3.0-or-later
"""STEP files as Open CASCADE reads them, where it is installed."""

from types import SimpleNamespace

import pytest


def read_step(path):
    """What is in a file: valid, solids, faces, volume, centre, lowest and highest corner; lengths in
    millimetres, whatever the file's unit.
    """
    pytest.importorskip("OCP", reason="Open CASCADE is not installed")
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.STEPControl import STEPControl_Reader
    from OCP.TopAbs import TopAbs_FACE, TopAbs_SOLID

    reader = STEPControl_Reader()
    assert reader.ReadFile(str(path)) == IFSelect_RetDone
    reader.TransferRoots()
    shape = reader.OneShape()
    mass, box = GProp_GProps(), Bnd_Box()
    BRepGProp.VolumeProperties_s(shape, mass)
    BRepBndLib.AddOptimal_s(shape, box)
    return SimpleNamespace(
        valid=BRepCheck_Analyzer(shape).IsValid(),
        solids=count(shape, TopAbs_SOLID),
        faces=count(shape, TopAbs_FACE),
        volume=mass.Mass(),
        centre=coordinates(mass.CentreOfMass()),
        lowest=coordinates(box.CornerMin()),
        highest=coordinates(box.CornerMax()),
    )


def count(shape, kind):
    from OCP.TopExp import TopExp_Explorer

    found, number = TopExp_Explorer(shape, kind), 0
    while found.More():
        number += 1
        found.Next()
    return number


def coordinates(point):
    return point.X(), point.Y(), point.Z()
