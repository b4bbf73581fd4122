# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces with known answers, on point forces and on pads: spheres, the Clifford torus, caps."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import discrete_fairing as df
import from_tests
import inscribed
import numpy as np
import table

PADS = (0.0, 1.0)
HULLS = {8: 40, 12: 40, 20: 30, 40: 10, 100: 4}  # points: how many of them
TIGHT = {"relative_residual": 1e-8, "step_tolerance": 1e-9, "max_steps": 40}


def solids() -> Iterator[tuple[str, Any, Any]]:
    """Yields kind, vertices on the unit sphere and faces of each mesh."""
    for name, make in inscribed.NAMED.items():
        points, faces = make()
        size = np.linalg.norm(points, axis=1)[:, None]
        yield "solids, cut" if "_cut" in name else "solids", points / size, faces
    for count, number in HULLS.items():
        for seed in range(number):
            yield f"hulls of {count}", *from_tests.small_meshes().random_hull(count, seed)


def spheres(levels: int) -> list[tuple[Any, ...]]:
    """A row a kind and pad size: how many, how many within 1e-5 by default options, the median and
    the largest error of a radius."""
    found: dict[tuple[str, float], list[float]] = {}
    for kind, points, faces in solids():
        for pad in PADS:
            surface = df.fair(
                points,
                faces,
                levels=levels,
                energy="total_curvature",
                pad_size=pad,
                relative_residual=1e-8,
            ).vertices
            error = np.abs(np.linalg.norm(surface, axis=1) - 1).max()
            found.setdefault((kind, pad), []).append(float(error))
    return [
        (kind, levels, pad, len(e), sum(x <= 1e-5 for x in e), float(np.median(e)), max(e))
        for (kind, pad), e in found.items()
    ]


def off_torus(points: np.ndarray) -> float:
    """Root mean square distance from the torus of radii √2 and 1."""
    ring = np.hypot(points[:, 0], points[:, 1]) - 2**0.5
    return float(np.sqrt(np.mean((np.hypot(ring, points[:, 2]) - 1) ** 2)))


def clifford(levels: tuple[int, ...] = (1, 2, 3, 4)) -> list[tuple[Any, ...]]:
    """A row a mesh and pad size: the distance on each level."""
    meshes = from_tests.small_meshes()
    rows = []
    for around, across in ((6, 5), (8, 6), (10, 8)):
        quads = meshes.torus(around, across)
        for name, mesh in (("quads", quads), ("triangles", (quads[0], meshes.cut_quads(quads)[1]))):
            for pad in PADS:
                errors = [
                    off_torus(
                        df.fair(
                            *mesh, levels=n, energy="total_curvature", pad_size=pad, **TIGHT
                        ).vertices
                    )
                    for n in levels
                ]
                rows.append((f"{around}×{across} {name}", pad, *errors))
    return rows


def cap(angle: float, rings: int, around: int) -> tuple[np.ndarray, list[list[int]]]:
    """A spherical cap to `angle` (radians) from the pole, in rings of as many quads."""
    polar = angle * np.arange(1, rings + 1) / rings
    turn = 2 * np.pi * np.arange(around) / around
    ring = np.stack(
        [
            np.outer(np.sin(polar), np.cos(turn)),
            np.outer(np.sin(polar), np.sin(turn)),
            np.outer(np.cos(polar), np.ones(around)),
        ],
        -1,
    ).reshape(-1, 3)
    after = (np.arange(around) + 1) % around
    faces = [[0, 1 + k, 1 + int(after[k])] for k in range(around)]
    for r in range(rings - 1):
        inner, outer = 1 + r * around, 1 + (r + 1) * around
        faces += [
            [inner + k, outer + k, outer + int(after[k]), inner + int(after[k])]
            for k in range(around)
        ]
    return np.concatenate([[[0, 0, 1.0]], ring]), faces


def caps() -> list[tuple[Any, ...]]:
    """A row a mesh and energy: the largest error of a radius, for caps of 30°, 60° and 90°."""
    rows = []
    for rings, around in ((4, 24), (6, 36)):
        for energy, pad in [
            *((e, p) for e in ("thin_plate", "total_curvature") for p in PADS),
            ("minimum_variation", None),
        ]:
            options = TIGHT | ({} if pad is None else {"pad_size": pad})
            errors = [
                np.abs(
                    np.linalg.norm(
                        df.fair(
                            *cap(np.radians(a), rings, around), levels=3, energy=energy, **options
                        ).vertices,
                        axis=1,
                    )
                    - 1
                ).max()
                for a in (30, 60, 90)
            ]
            rows.append((f"{rings} rings of {around}, {energy}", pad, *map(float, errors)))
    return rows


def run() -> dict[str, Any]:
    """Measures the data of all tables."""
    result = {"spheres": spheres(2) + spheres(3), "clifford": clifford(), "caps": caps()}
    return result


def exact_table(result: dict[str, Any]) -> str:
    """Spheres and tori that are known, on point forces and on pads."""
    found = result
    rows = []
    spheres: dict[tuple[str, int], dict[float, list[Any]]] = {}
    for name, level, size, *rest in found["spheres"]:
        spheres.setdefault((name, level), {})[size] = rest
    for (name, level), sizes in spheres.items():
        cells = [f"{sizes[s][1]} of {sizes[s][0]}" for s in (0.0, 1.0)]
        rows.append([f"{name}, level {level}", "spheres met", *cells])
    tori: dict[str, dict[float, list[float]]] = {}
    for name, size, *by_level in found["clifford"]:
        tori.setdefault(name, {})[size] = by_level
    for name, sizes in tori.items():
        cells = [f"{sizes[s][2]:.2e}".replace("e-0", "e-") for s in (0.0, 1.0)]
        rows.append([f"Clifford torus, {name}, level 3", "distance", *cells])
    return table.markdown(["known surface", "measure", "point forces", "pads of 1"], rows)


def levels_table(result: dict[str, Any]) -> str:
    """The distance from the Clifford torus on each level, and the order from each to the next."""
    rows = []
    for name, size, *errors in result["clifford"]:
        orders = [f"{np.log2(a / b):.1f}" for a, b in pairwise(errors)]
        cells = [f"{e:.2e}".replace("e-0", "e-") for e in errors]
        rows.append([name, "pads" if size else "point forces", *cells, ", ".join(orders)])
    levels = [f"level {n}" for n in (1, 2, 3, 4)]
    return table.markdown(["control mesh", "held by", *levels, "orders"], rows)


def caps_table(result: dict[str, Any]) -> str:
    """Caps of a sphere on their boundary circle: how far surfaces are off, in shares of the radius."""
    rows = []
    for name, size, *errors in result["caps"]:
        if size == 0.0:
            continue  # point forces
        mesh, energy = name.split(", ")
        cells = [f"{100 * e:.2g} %" if e > 1e-4 else table.short(e) for e in errors]
        rows.append([mesh, energy.replace("_", " "), *cells])
    return table.markdown(["control mesh", "energy", "cap of 30°", "60°", "90°"], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "exact": exact_table(result),
        "exact.caps": caps_table(result),
        "exact.levels": levels_table(result),
    }
