# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's control meshes, whose modules have names of their own here."""

import importlib.util
import sys
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def _module(name: str):
    """A module of the examples, under another name: tests have a control_meshes.py, too."""
    spec = importlib.util.spec_from_file_location(f"example_{name}", EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # which dataclasses look up
    spec.loader.exec_module(module)
    return module


def hull():
    """((vertices, faces), creases (k, 2)): a boat of 9 m."""
    return _with_creases(_module("control_meshes").hull())


def branching():
    """Vertices and faces of genus 2."""
    return _with_creases(_module("control_meshes").branching())[0]


def fender():
    """Vertices and faces: open, with four smooth borders."""
    own = sys.modules.pop("control_meshes", None)
    sys.modules["control_meshes"] = _module("control_meshes")  # which the other module imports
    try:
        return _with_creases(_module("modelling_meshes").fender())[0]
    finally:
        sys.modules.pop("control_meshes")
        if own is not None:
            sys.modules["control_meshes"] = own


def _with_creases(mesh):
    return (mesh.vertices, mesh.faces), mesh.crease_edges
