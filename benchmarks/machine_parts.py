# SPDX-License-Identifier: GPL-3.0-or-later
"""Machine parts with known surfaces: the distances of surfaces over their coarse cages. Folds from 30° on are
sharp, for ours and for Subdivision Surface alike.
"""

import math
from typing import Any

import discrete_fairing as df
import from_tests
import numpy as np
import rivals
import table

LEVELS = 3
FOLD, CORNER = math.radians(30), math.radians(45)  # as Fair for > Mechanical has them
ENERGIES = ("thin_plate", "total_curvature", "minimum_variation")
SUBDIVISION = {
    "Subdivision Surface": rivals.catmull_clark,
    "the same, cage pushed out": rivals.catmull_clark_through,
}
TOOLS = (*SUBDIVISION, *ENERGIES)


def folds(vertices: np.ndarray, faces: list[tuple[int, ...]]) -> list[tuple[int, int]]:
    """The edges whose faces turn by more than FOLD."""
    normal: dict[tuple[int, int], np.ndarray] = {}
    for face in faces:
        a, b, c = vertices[list(face[:3])]
        across = np.cross(b - a, c - a)
        for k, v in enumerate(face):
            normal[v, face[(k + 1) % len(face)]] = across / np.linalg.norm(across)
    return [
        (a, b)
        for (a, b), own in normal.items()
        if a < b and (b, a) in normal and own @ normal[b, a] < math.cos(FOLD)
    ]


def surface(vertices: np.ndarray, faces: list[tuple[int, ...]], tool: str) -> np.ndarray:
    """The points of the surface that a tool makes."""
    if tool in SUBDIVISION:
        polygons = [list(face) for face in faces]
        return SUBDIVISION[tool](vertices, polygons, LEVELS, folds(vertices, faces))[0]
    ours = df.fair(vertices, faces, LEVELS, energy=tool, crease_angle=FOLD, corner_angle=CORNER)
    return ours.vertices


def run() -> dict[str, Any]:
    """Measures all parts: distances in thousandths of the largest extent."""
    result: dict[str, Any] = {}
    for name, make in from_tests.machine_parts().PARTS.items():
        vertices, faces, off = make()
        for tool in TOOLS:
            away = 1e3 * off(surface(vertices, faces, tool)) / np.ptp(vertices, axis=0).max()
            found = {"rms": float(np.sqrt((away**2).mean())), "largest": float(away.max())}
            result.setdefault(name, {})[tool] = found
    return result


def machine_parts_table(result: dict[str, Any]) -> str:
    """Distances from the known parts."""
    rows = [
        [
            part,
            *(
                " · ".join(f"{d:.2g}" if d > 1e-3 else "0" for d in found[tool].values())
                for tool in TOOLS
            ),
        ]
        for part, found in result.items()
    ]
    return table.markdown(["part", *(tool.replace("_", " ") for tool in TOOLS)], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "machine_parts": machine_parts_table(result),
    }
