# SPDX-License-Identifier: GPL-3.0-or-later
"""The collection of real meshes beside the project; without it their tests are skipped."""

import json
from pathlib import Path

import numpy as np
import pytest

SHARED = Path(__file__).resolve().parents[2].parent / "shared" / "data"


def shared_files(folder: str, *suffixes: str) -> list:
    """Every mesh file below SHARED/folder, for parametrize; one skipped one if there is none."""
    suffixes = suffixes or (".obj",)
    top = SHARED / folder
    files = (
        sorted(path for path in top.rglob("*") if path.suffix.lower() in suffixes)
        if top.is_dir()
        else []
    )
    if not files:
        return [
            pytest.param(
                None, marks=pytest.mark.skip(reason=f"no shared meshes {folder}"), id="absent"
            )
        ]
    return [pytest.param(path, id=str(path.relative_to(SHARED).with_suffix(""))) for path in files]


def read_obj(path: Path) -> tuple[np.ndarray, list[list[int]]]:
    """Vertices (n, 3) and polygons as lists of vertex ids; texture and normal ids are left out."""
    vertices, faces = [], []
    for line in path.read_text(errors="replace").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            ids = [int(word.split("/")[0]) for word in words[1:]]
            faces.append([i - 1 if i > 0 else len(vertices) + i for i in ids])
    return np.array(vertices, float).reshape(-1, 3), faces


def creases_of(path: Path, sharper_than: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Crease edges (k, 2) and corner vertices (c,) of the list beside a mesh; both empty without one."""
    listed = path.with_name(path.stem + ".creases.json")
    found = json.loads(listed.read_text()) if listed.is_file() else {}
    edges = [edge[:2] for edge in found.get("edges", []) if edge[2] > sharper_than]
    corners = [corner[0] for corner in found.get("corners", []) if corner[1] > sharper_than]
    return np.array(edges, int).reshape(-1, 2), np.array(corners, int)
