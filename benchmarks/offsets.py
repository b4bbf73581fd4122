# SPDX-License-Identifier: GPL-3.0-or-later
"""Scattered offsets: what Near does to their error, and when strain finds the one that is wrong.

9 x 7 vertices over 1 x 0.75, an eighth apart. All inner ones are off by a normal scatter, one of
them by six times as much.
"""

from typing import Any

import discrete_fairing as df
import numpy as np
import table

SCATTER = 0.0007
PLANTED = 6 * SCATTER
TOLERANCES = (0.0005, 0.001, 0.002, 0.004)
SEEDS = 20

X, Y = np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 0.75, 7), indexing="ij")
IDS = np.arange(X.size).reshape(X.shape)
FACES = np.stack([IDS[:-1, :-1], IDS[1:, :-1], IDS[1:, 1:], IDS[:-1, 1:]], -1).reshape(-1, 4)
INNER = IDS[1:-1, 1:-1].ravel()


def shapes() -> dict[str, np.ndarray]:
    """Heights (9, 7)."""
    x, y = X - 0.5, Y - 0.375
    squared = x**2 + y**2
    return {
        "plane": 0 * x,
        "saddle": 0.2 * (x**2 - y**2),
        "wide bump": 0.15 * np.exp(-squared / 0.3),
        "narrow bump": 0.15 * np.exp(-squared / 0.08),
    }


def scattered(truth: np.ndarray, seed: int) -> tuple[np.ndarray, int]:
    """Vertices (63, 3), and which one is wrong."""
    random = np.random.default_rng(seed)
    vertices = truth.copy()
    vertices[INNER, 2] += random.normal(0, SCATTER, INNER.size)
    wrong = int(random.choice(INNER))
    vertices[wrong, 2] = truth[wrong, 2] + PLANTED
    return vertices, wrong


def error(vertices: np.ndarray, truth: np.ndarray) -> float:
    """Root mean square distance of inner vertices from the truth."""
    return float(np.sqrt(np.mean(np.sum((vertices - truth)[INNER] ** 2, axis=1))))


def run() -> dict[str, Any]:
    """One row a shape."""
    result: dict[str, Any] = {}
    rows = []
    for name, height in shapes().items():
        truth = np.stack([X, Y, height], -1).reshape(-1, 3)
        floor = float(np.nanmax(np.abs(df.strain(truth, FACES).lengths)))
        found = 0
        errors = np.zeros(1 + len(TOLERANCES))
        for seed in range(SEEDS):
            vertices, wrong = scattered(truth, seed)
            found += int(df.strain(vertices, FACES).worst(1)[0]) == wrong
            held = [
                df.fair(
                    vertices, FACES, levels=1, interpolation="approximate", tolerance=bound
                ).vertices[: X.size]
                for bound in TOLERANCES
            ]
            errors += [error(points, truth) for points in (vertices, *held)]
        errors /= SEEDS
        result[name] = {"floor": floor, "found": found, "errors": errors.tolist()}
        rows.append([name, 1e3 * floor, found, *(1e3 * errors)])
    heads = ["shape", "largest strain unscattered", f"found of {SEEDS}", "error before"]
    table.show(
        "Offsets, lengths in thousandths",
        [*heads, *(f"near {1e3 * t:g}" for t in TOLERANCES)],
        rows,
    )
    return result


if __name__ == "__main__":
    run()
