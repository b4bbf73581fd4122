# SPDX-License-Identifier: GPL-3.0-or-later
"""Pads in place of point forces: their effect on curvature, and their cost. `fender` is 9 x 5 vertices over a
wheel arch: nine columns at x = -4 … 4, in each five rows evenly from the arch (straight pieces) to the
upper border (a slight arc), and a depth that swells in a shoulder and turns out again to a lip.
"""

from typing import Any

import curvature_peaks
import discrete_fairing as df
import numpy as np
import table
from from_tests import measures

SIZES = (0.0, 0.25, 0.5, 1.0)
LEVELS = 3
ROUNDS = 3
ARCH = np.array([0.0, 0.0, 0.64, 1.88, 2.1, 1.88, 0.64, 0.0, 0.0])


def fender() -> tuple[np.ndarray, np.ndarray]:
    """The fender: vertices (45, 3) and quads (32, 4)."""
    x = np.arange(-4.0, 5.0)
    top = 3.69 - 0.025 * (x + 0.25) ** 2
    share = np.linspace(0, 1, 5)
    height = ARCH + share[:, None] * (top - ARCH)
    depth = np.array([0.55, 0.42, 0.5, 0.3, -0.6])[:, None] - 0.015 * x**2
    points = np.stack([np.broadcast_to(x, height.shape), -depth, height], axis=2).reshape(-1, 3)
    first = np.add.outer(9 * np.arange(4), np.arange(8)).ravel()
    return points, first[:, None] + [0, 1, 10, 9]


def step() -> tuple[np.ndarray, np.ndarray]:
    """An extrusion that should remain one: 13 x 13 vertices, a step along x, constant along y."""
    along = np.linspace(-3, 3, 13)
    x, y = np.meshgrid(along, along)
    points = np.stack([x, y, 0.6 * np.tanh(x)], axis=2).reshape(-1, 3)
    first = np.add.outer(13 * np.arange(12), np.arange(12)).ravel()
    return points, first[:, None] + [0, 1, 14, 13]


def mean_curvature(
    points: np.ndarray, triangles: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean curvature at every point, meaningless on the rim; then what its differences need:

    the edges (k, 2), once a triangle, and half their cotangents.
    """
    corner = points[triangles]
    edges, weights = [], []
    area = np.zeros(len(points))
    normal = np.zeros_like(points)
    face_normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    face_area = np.linalg.norm(face_normal, axis=1) / 2
    for c in range(3):
        a, b = corner[:, (c + 1) % 3] - corner[:, c], corner[:, (c + 2) % 3] - corner[:, c]
        weights.append((a * b).sum(1) / (4 * face_area))
        edges.append(triangles[:, [(c + 1) % 3, (c + 2) % 3]])
        np.add.at(area, triangles[:, c], face_area / 3)
        np.add.at(normal, triangles[:, c], face_normal)
    edges, weights = np.concatenate(edges), np.concatenate(weights)
    laplacian = np.zeros_like(points)
    difference = weights[:, None] * (points[edges[:, 1]] - points[edges[:, 0]])
    np.add.at(laplacian, edges[:, 0], difference)
    np.add.at(laplacian, edges[:, 1], -difference)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return -(laplacian * normal).sum(1) / (2 * area), edges, weights


def rings_from_rim(triangles: np.ndarray, count: int) -> np.ndarray:
    """(count,) int: how many edges each vertex is from the rim; many on closed surfaces."""
    distance = np.full(count, 1 << 20)
    distance[measures.rim(triangles)] = 0
    for _ in range(64):
        nearest = distance[triangles].min(1) + 1
        before = distance.copy()
        for c in range(3):
            np.minimum.at(distance, triangles[:, c], nearest)
        if (before == distance).all():
            break
    return distance


def calm(result: df.Result, levels: int = LEVELS) -> dict[str, float]:
    """Dirichlet energy of the mean curvature and its largest size, away from borders.

    Away is half a control face and more.
    """
    triangles = result.triangles.astype(np.int64)
    curvature, edges, weights = mean_curvature(result.vertices, triangles)
    inside = rings_from_rim(triangles, len(result.vertices)) > 2**levels // 2
    both = inside[edges].all(1)
    change = curvature[edges[:, 0]] - curvature[edges[:, 1]]
    return {
        "dirichlet": float((weights * change**2)[both].sum()),
        "largest": float(np.abs(curvature[inside]).max()),
        "energy": measures.total_curvature(result.vertices, triangles) / (8 * np.pi),
    }


def scallop(result: df.Result) -> float:
    """The largest distance of the middle of the step from a straight line along y, between a row of control
    vertices and half-way to the next.
    """
    points = result.vertices
    profiles = []
    for y in (0.0, 0.25):
        line = points[(np.abs(points[:, 1] - y) < 0.01) & (np.abs(points[:, 0]) < 2.5)]
        profiles.append(line[np.argsort(line[:, 0])])
    between = np.interp(profiles[1][:, 0], profiles[0][:, 0], profiles[0][:, 2])
    inner = np.abs(profiles[1][:, 0]) < 2
    return float(np.abs(between - profiles[1][:, 2])[inner].max())


def peaks_and_costs() -> dict[str, Any]:
    """Thin plate on real meshes: curvature at control vertices over their ring's mean; cost."""
    result: dict[str, Any] = {}
    for name, vertices, faces, levels in curvature_peaks.control_meshes():
        seconds = {size: float("inf") for size in SIZES}
        for size in SIZES * ROUNDS:  # in turn, so that whatever else the machine does meets all
            surface = df.fair(vertices, faces, levels=levels, pad_size=size, measure=False)
            seconds[size] = min(seconds[size], surface.report["seconds"]["solve"])
            if f"{name}, {size}" in result:
                continue
            finest = surface.report["levels"][-1]
            triangles = surface.triangles.astype(np.int64)
            found = curvature_peaks.ratios(surface.vertices, triangles, len(vertices))
            entry = curvature_peaks.summary(found)
            entry |= {key: finest[key] for key in ("iterations", "pad_corrections", "pad_force")}
            result[f"{name}, {size}"] = entry
        for size in SIZES:
            entry = result[f"{name}, {size}"]
            entry["seconds"], entry["times"] = seconds[size], seconds[size] / seconds[0.0]
    return result


def near_along_normals() -> dict[str, Any]:
    """Total curvature: control vertices within a tolerance, on points and on pads of 1.

    Solves are linear ones, on all levels. Tolerances are shares of the mean control edge.
    """
    result: dict[str, Any] = {}
    meshes = [*curvature_peaks.control_meshes(), ("fender", *fender(), LEVELS)]
    for name, vertices, faces, levels in meshes:
        sides = [(face[i - 1], face[i]) for face in faces for i in range(len(face))]
        corners = vertices[np.array(sides)]
        edge = np.linalg.norm(corners[:, 0] - corners[:, 1], axis=1).mean()
        for size in (0.0, 1.0):
            for share in (0.0, 0.02, 0.1):
                bound = {"interpolation": "approximate", "tolerance": share * edge} if share else {}
                surface = df.fair(
                    vertices,
                    faces,
                    levels,
                    "total_curvature",
                    pad_size=size,
                    boundary="linear" if name == "fender" else "curve",
                    **bound,
                )
                triangles = surface.triangles.astype(np.int64)
                found = curvature_peaks.ratios(surface.vertices, triangles, len(vertices))
                entry = curvature_peaks.summary(found)
                by_level = surface.report["curvature"]
                entry["energy"] = by_level[-1]["energy"] / (8 * np.pi)
                entry["steps"] = [len(level["steps"]) for level in by_level]
                entry["solves"] = [
                    sum(step["pad_corrections"] + 1 for step in level["steps"])
                    for level in by_level
                ]
                entry["gap"] = surface.report["constraint_gap"]
                result[f"{name}, {size}, {share}"] = entry
    return result


def run() -> dict[str, Any]:
    """Measures all tables."""
    result: dict[str, Any] = {"real": peaks_and_costs()}
    result["near along normals"] = near_along_normals()
    for energy in ("thin_plate", "total_curvature", "minimum_variation"):
        for size in SIZES[:1] if energy == "minimum_variation" else SIZES:
            surface = df.fair(
                *fender(), levels=LEVELS, energy=energy, pad_size=size, boundary="linear"
            )
            found = calm(surface)
            found["scallop"] = scallop(
                df.fair(*step(), levels=LEVELS, energy=energy, pad_size=size)
            )
            result[f"fender, {energy}, {size}"] = found
    return result


def fender_table(result: dict[str, Any]) -> str:
    """Dirichlet energy of the mean curvature on the fender."""
    found = result
    rows = []
    for energy in ("thin_plate", "total_curvature", "minimum_variation"):
        cells = [found.get(f"fender, {energy}, {size}") for size in ("0.0", "0.5", "1.0")]
        rows.append(
            [
                energy.replace("_", " "),
                *(table.short(c["dirichlet"], 3) if c else "" for c in cells),
            ]
        )
    return table.markdown(["", "point forces", "pads of ½", "pads of 1"], rows)


def near_on_pads_table(result: dict[str, Any]) -> str:
    """Total curvature with a tolerance of 2 % of an edge, on points and on pads."""
    found = result["near along normals"]
    heads = ["", "points", "pads", "energy: Through, points, pads", "solves: Through, Near"]
    rows = []
    for name in dict.fromkeys(key.rsplit(", ", 2)[0] for key in found):
        through, points, near = (
            found[f"{name}, {k}"] for k in ("1.0, 0.0", "0.0, 0.02", "1.0, 0.02")
        )
        row = [" / ".join(f"{v:.2f}" for v in f["over_mean"][1:]) for f in (points, near)]
        row.append(", ".join(table.short(f["energy"], 3) for f in (through, points, near)))
        rows.append([name, *row, f"{through['solves'][-1]}, {near['solves'][-1]}"])
    return table.markdown(heads, rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "pads.fender": fender_table(result),
        "pads.near": near_on_pads_table(result),
    }


if __name__ == "__main__":
    run()
