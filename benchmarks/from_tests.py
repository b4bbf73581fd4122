# SPDX-License-Identifier: GPL-3.0-or-later
"""Modules of the tests that benchmarks use: small control meshes, readers of the collection beside
the project, and measures of a surface."""

import importlib
import importlib.util
import sys
from pathlib import Path
from types import ModuleType

TESTS = Path(__file__).resolve().parent.parent / "tests" / "python"
sys.path.append(str(TESTS))  # last: benchmarks has a control_meshes of its own

measures = importlib.import_module("surface_measures")
judge = importlib.import_module("surface_judge")


def small_meshes() -> ModuleType:
    """tests/python/control_meshes.py; benchmarks has a module of the same name."""
    spec = importlib.util.spec_from_file_location(
        "small_control_meshes", TESTS / "control_meshes.py"
    )
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def inscribed() -> ModuleType:
    """tests/python/inscribed.py, which imports those control meshes by their own name."""
    ours = sys.modules.pop("control_meshes", None)
    sys.modules["control_meshes"] = small_meshes()
    sys.path.insert(0, str(TESTS))
    try:
        return importlib.import_module("inscribed")
    finally:
        sys.path.remove(str(TESTS))
        sys.modules.pop("control_meshes")
        if ours:
            sys.modules["control_meshes"] = ours


def readers() -> tuple[ModuleType, ModuleType]:
    """mesh_files and shared_data."""
    return importlib.import_module("mesh_files"), importlib.import_module("shared_data")


def hard_meshes() -> tuple[ModuleType, ModuleType]:
    """bevelled_boxes and thin_meshes."""
    return importlib.import_module("bevelled_boxes"), importlib.import_module("thin_meshes")
