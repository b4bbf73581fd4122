# SPDX-License-Identifier: GPL-3.0-or-later
"""Known panels and hulls, sampled at a few vertices: which energy gives the surface back? Stripes show
normals, so the measure is the angle of normals, over all points and at the corners.
"""

import time
from collections.abc import Callable, Iterator
from typing import Any

import discrete_fairing as df
import numpy as np
import rivals
import table

LEVELS = 3
CORNER = 1.0  # cells: how near to a corner of the panel counts as there
STEP = 1e-6  # of the differences that give true normals

Height = Callable[[np.ndarray, np.ndarray], np.ndarray]
MODELS: dict[str, tuple[str, Height]] = {
    "bonnet": ("panel", lambda x, y: 0.3 * (1 - 0.4 * x**2) * (1 - 0.25 * y**2) - 0.05 * x),
    "door": ("panel", lambda x, y: 0.25 * np.sqrt(4 - (x - 0.2) ** 2) + 0.06 * np.tanh(3 * y)),
    "roof": ("panel", lambda x, y: 0.2 * np.cos(1.1 * x) * np.cos(0.7 * y)),
    "wing": ("panel", lambda x, y: 0.25 * np.sqrt(1.25 + y) * (1 - 0.3 * x**2)),
    "fender flare": ("panel", lambda x, y: 0.25 * np.exp(-2.5 * (y + 0.5) ** 2) * np.cos(0.9 * x)),
    "saddle": ("panel", lambda x, y: 0.2 * x**2 - 0.25 * y**2 + 0.1 * x * y),
    "Wigley": ("hull", lambda x, y: 0.3 * (1 - 0.8 * x**2) * (1 - 0.7 * (0.5 - 0.5 * y) ** 2)),
    "flared bow": ("hull", lambda x, y: 0.35 * (1 - 0.5 * (x + 0.2) ** 2) + 0.12 * y * np.exp(x)),
    "round bilge": ("hull", lambda x, y: 0.3 * np.tanh(2 * (y + 1.2)) * np.cos(0.8 * x)),
    "transom": ("hull", lambda x, y: 0.3 * np.sqrt(2.2 - x) * (1 - 0.2 * (y - 1) ** 2)),
    "tumblehome": ("hull", lambda x, y: 0.25 * (1 - 0.4 * x**2) * np.cos(1.2 * (y - 0.3))),
    "reverse sheer": ("hull", lambda x, y: 0.2 * np.sin(1.2 * y + 0.4 * x) + 0.1 * (1 - x**2)),
}
SETTINGS = {
    "thin plate": {"energy": "thin_plate"},
    "total curvature": {"energy": "total_curvature"},
    "minimum variation": {"energy": "minimum_variation"},
    "thin plate, limit": {"energy": "thin_plate", "interpolation": "limit"},  # what Panel takes
}


def grid(height: Height) -> tuple[np.ndarray, list[list[int]]]:
    """A control mesh of 9 × 7 vertices on the surface, spaced unevenly as if by hand."""
    u, v = np.linspace(-1, 1, 9), np.linspace(-1, 1, 7)
    x, y = np.meshgrid(u + 0.06 * np.sin(3 * u), v + 0.08 * np.sin(2 * v), indexing="ij")
    points = np.stack([x, y, height(x, y)], axis=2).reshape(-1, 3)
    cells = [(i, j) for i in range(8) for j in range(6)]
    faces = [[7 * i + j, 7 * i + 7 + j, 7 * i + 8 + j, 7 * i + 1 + j] for i, j in cells]
    return points, faces


def normals(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(n, 3): unit normals, weighted by area."""
    a, b, c = points[triangles].swapaxes(0, 1)
    total = np.zeros_like(points)
    for corner in triangles.T:
        np.add.at(total, corner, np.cross(b - a, c - a))
    return total / np.linalg.norm(total, axis=1)[:, None]


def judged(points: np.ndarray, triangles: np.ndarray, height: Height) -> dict[str, float]:
    """Degrees between the normals and the true ones, off the border; and the distance, rms and as a
    share of the panel's half width.
    """
    x, y, z = points.T
    steep = [
        (height(x + STEP * (k == 0), y + STEP * (k == 1)) - height(x, y)) / STEP for k in (0, 1)
    ]
    true = np.stack([-steep[0], -steep[1], np.ones(len(x))], axis=1)
    length = np.linalg.norm(true, axis=1)
    cosine = np.einsum("ij,ij->i", normals(points, triangles), true) / length
    angle = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    pairs = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, uses = np.unique(pairs, axis=0, return_counts=True)
    inner = np.ones(len(points), bool)  # one-sided means of faces say little on the border
    inner[edges[uses == 1].ravel()] = False
    corner = (np.abs(x) > 1.06 - 0.25 * CORNER) & (np.abs(y) > 1.07 - 0.33 * CORNER)
    return {
        "rms": float(np.sqrt((angle[inner] ** 2).mean())),
        "largest": float(angle[inner].max()),
        "at corners": float(angle[inner & corner].max()),
        "distance": float(np.sqrt((((z - height(x, y)) / length) ** 2).mean())),
    }


def surfaces(points: np.ndarray, faces: list[list[int]]) -> Iterator[tuple[str, Any, float]]:
    """Yields name, (points, triangles) and CPU seconds of each surface."""
    yield "Subdivision Surface", rivals.catmull_clark(points, faces, LEVELS), 0.0
    yield "cage pushed out", rivals.catmull_clark_through(points, faces, LEVELS), 0.0
    corners = [0, 6, 56, 62]
    for name, options in SETTINGS.items():
        start = time.process_time()
        ours = df.fair(points, faces, LEVELS, corner_vertices=corners, threads=1, **options)
        taken = time.process_time() - start
        yield name, (ours.vertices, ours.triangles.astype(np.int64)), taken


def run() -> dict[str, Any]:
    """Measures all models."""
    result: dict[str, Any] = {}
    for name, (job, height) in MODELS.items():
        points, faces = grid(height)
        for surface, mesh, taken in surfaces(points, faces):
            found = {**judged(*mesh, height), "seconds": taken}
            result.setdefault(job, {}).setdefault(name, {})[surface] = found
    return result


def jobs_table(result: dict[str, Any]) -> str:
    """Angles between the normals and the true ones on known panels and hulls."""
    tools = {
        "Subdivision Surface": "Subdivision Surface",
        "cage pushed out": "the same, cage pushed out",
        "thin plate, limit": "thin plate, *Limit*",
        "thin plate": "thin plate",
        "total curvature": "total curvature",
        "minimum variation": "minimum variation",
    }
    rows = [
        [job, model, *(f"{found[t]['rms']:.2g} · {found[t]['at corners']:.2g}" for t in tools)]
        for job, models in result.items()
        for model, found in models.items()
    ]
    return table.markdown(["job", "model", *tools.values()], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "jobs": jobs_table(result),
    }
