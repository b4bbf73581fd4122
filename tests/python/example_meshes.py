# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes of the examples, as arrays."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "examples"))

import demo_meshes  # noqa: E402
import modelling_meshes  # noqa: E402


def hull():
    """((vertices, faces), creases (k, 2)): a boat of 9 m."""
    return _with_creases(demo_meshes.hull())


def branching():
    """Vertices and faces of genus 2."""
    return _with_creases(demo_meshes.branching())[0]


def fender():
    """Vertices and faces: open, with four smooth borders."""
    return _with_creases(modelling_meshes.fender())[0]


def _with_creases(mesh):
    return (mesh.vertices, mesh.faces), mesh.crease_edges
