# SPDX-License-Identifier: GPL-3.0-or-later
"""Modules of the tests that benchmarks use: small control meshes, and readers of the collection
beside the project."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

TESTS = Path(__file__).resolve().parent.parent / "tests" / "python"


def small_meshes() -> ModuleType:
    """tests/python/control_meshes.py; benchmarks has a module of the same name."""
    spec = importlib.util.spec_from_file_location(
        "small_control_meshes", TESTS / "control_meshes.py"
    )
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def readers() -> tuple[ModuleType, ModuleType]:
    """mesh_files and shared_data."""
    if str(TESTS) not in sys.path:
        sys.path.append(str(TESTS))
    import mesh_files
    import shared_data

    return mesh_files, shared_data
