# SPDX-License-Identifier: GPL-3.0-or-later
"""Modules of the tests that benchmarks use: small control meshes, readers of the collection beside
the project, and measures of a surface."""

import importlib
import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"
TESTS = Path(__file__).resolve().parent.parent / "tests" / "python"
sys.path.append(str(TESTS))  # last: benchmarks has a control_meshes of its own

measures = importlib.import_module("surface_measures")
thin_walls = importlib.import_module("thin_walls")


def small_meshes() -> ModuleType:
    """tests/python/control_meshes.py; benchmarks has a module of the same name."""
    spec = importlib.util.spec_from_file_location(
        "small_control_meshes", TESTS / "control_meshes.py"
    )
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def solids() -> dict:
    """tests/python/inscribed_solids.py: by name, makers of control meshes."""
    return _beside_own_meshes("inscribed_solids", TESTS).SOLIDS


def modelled() -> ModuleType:
    """examples/modelling_meshes.py, a fender and a mug, which imports control meshes of its own."""
    return _beside_own_meshes("modelling_meshes", EXAMPLES)


def drawn_panels() -> ModuleType:
    """examples/panel_meshes.py."""
    return _beside_own_meshes("panel_meshes", EXAMPLES)


def machine_parts() -> ModuleType:
    """examples/machine_meshes.py."""
    return _beside_own_meshes("machine_meshes", EXAMPLES)


def _beside_own_meshes(name: str, folder: Path) -> ModuleType:
    """The module `name`, to which control_meshes is the one in its own folder."""
    ours = sys.modules.pop("control_meshes", None)
    sys.path.insert(0, str(folder))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(str(folder))
        sys.modules.pop("control_meshes", None)
        if ours:
            sys.modules["control_meshes"] = ours


def readers() -> tuple[ModuleType, ModuleType]:
    """mesh_files and shared_data."""
    return importlib.import_module("mesh_files"), importlib.import_module("shared_data")


def collected(name: str) -> Any:
    """Vertices and polygons of a mesh of the collection beside the project; None if it is absent."""
    files, data = readers()
    found = sorted((data.SHARED / "good").rglob(f"*{name}"))
    if not found or found[0].suffix != ".ply":
        return files.read_mesh(found[0]) if found else None
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(found[0]))
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix(), [list(map(int, face)) for face in mesh.polygonal_face_list()]


def ragged_holes() -> ModuleType:
    """tests/python/ragged_holes.py."""
    return importlib.import_module("ragged_holes")
