# SPDX-License-Identifier: GPL-3.0-or-later
"""Points of a known dome, measured with an error: the distance between the dome and surfaces through or near
the points.
"""

from collections.abc import Iterator
from typing import Any

import discrete_fairing as df
import numpy as np
import rivals
import table

LEVELS = 3
SIDE = 9  # points
EDGE = 2 / (SIDE - 1)
DOMES = ((0.55, 1.2), (0.3, 2.5), (0.55, 0.6))  # height, turn in radians a half width
SCATTERS = (0.016, 0.048, 0.1)  # of an edge, root mean square
SEEDS = range(10)
NEAR = 0.1  # of an edge

FACES = [
    [SIDE * i + j, SIDE * i + SIDE + j, SIDE * i + SIDE + j + 1, SIDE * i + j + 1]
    for i in range(SIDE - 1)
    for j in range(SIDE - 1)
]


def surfaces(points: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """Yields the name and the points of each surface."""
    yield "Subdivision Surface", rivals.catmull_clark(points, FACES, LEVELS)[0]
    yield "through", df.fair(points, FACES, LEVELS).vertices
    near = df.fair(points, FACES, LEVELS, interpolation="approximate", tolerance=NEAR * EDGE)
    yield "near", near.vertices
    yield "eased", df.fair(df.ease(points, FACES).vertices, FACES, LEVELS).vertices


def run() -> dict[str, Any]:
    """Root mean square distances to the dome, in edges, means over the seeds."""
    even = np.linspace(-1, 1, SIDE)
    x, y = np.meshgrid(even, even, indexing="ij")
    result: dict[str, Any] = {}
    for height, turn in DOMES:
        for scatter in SCATTERS:
            off: dict[str, list[float]] = {}
            for seed in SEEDS:
                z = height * np.cos(turn * x) * np.cos(turn * y)
                z = z + np.random.default_rng(seed).normal(0, scatter * EDGE, z.shape)
                for name, found in surfaces(np.stack([x, y, z], axis=2).reshape(-1, 3)):
                    true = height * np.cos(turn * found[:, 0]) * np.cos(turn * found[:, 1])
                    error = float(np.sqrt(((found[:, 2] - true) ** 2).mean()))
                    off.setdefault(name, []).append(error / EDGE)
            result[f"{height} · {turn} · {scatter}"] = {
                name: float(np.mean(errors)) for name, errors in off.items()
            }
    return result


def measured_points_table(result: dict[str, Any]) -> str:
    """Distances of surfaces from a dome whose points were measured."""
    tools = ("through", "Subdivision Surface", "near", "eased")
    rows = [
        [*dome.split(" · "), *(f"{found[tool]:.2g}" for tool in tools)]
        for dome, found in result.items()
    ]
    names = ("through", "Subdivision Surface", "*Near*, a tenth", "*Points*")
    return table.markdown(["height", "turn", "scatter", *names], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "points": measured_points_table(result),
    }
