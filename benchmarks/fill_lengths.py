# SPDX-License-Identifier: GPL-3.0-or-later
"""The time of triangulating a ragged hole, and of the whole filling, against the length of its loop."""

from time import process_time
from typing import Any

import discrete_fairing as df
import fill_shapes
import from_tests
import numpy as np
import table

# as near to which as a hole comes: those of the ragged holes of scans, and ten times more
EDGES = (50, 100, 200, 500, 1000, 2000, 5000)
WAVES = 400  # along the rim of a ragged hole, whose radius is between 0.4 and 1 of the largest


def ragged_hole(edges: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points and triangles around a hole in a wavy sheet, and the loop, of about so many edges."""
    low, high = 4, 8
    while len(_cut(high)[2]) < edges:  # the length grows with the number of cells
        low, high = high, 2 * high
    while high - low > 1:
        cells = (low + high) // 2
        if len(_cut(cells)[2]) < edges:
            low = cells
        else:
            high = cells
    return _cut(high)


def _cut(radius: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A hole of so many cells' radius in a lattice, with its loop."""
    holes = from_tests.ragged_holes()
    n = 2 * radius + 9
    line = (np.arange(n) - (n - 1) / 2) / radius
    x, y = np.meshgrid(line, line, indexing="ij")
    points = np.stack([x, y, 0.3 * np.sin(2 * x) * np.cos(1.5 * y)], -1).reshape(-1, 3)
    faces = fill_shapes.lattice(n, n, (False, False))
    centre = points[faces].mean(axis=1)
    angle = np.arctan2(centre[:, 1], centre[:, 0])
    random = np.random.default_rng(0)
    lengths = random.uniform(0.4, 1.0, min(WAVES, 3 * radius))
    place = (angle / (2 * np.pi) + 0.5) * len(lengths)
    gone = np.hypot(centre[:, 0], centre[:, 1]) < lengths[place.astype(int) % len(lengths)]
    whole = faces[~gone]  # without islands, which are other pieces
    points, faces = holes.cut(points, whole, ~holes.largest_piece(whole))
    inner = [h for h in df.find_holes(points, faces) if abs(points[h]).max() < line[-2]]
    return points, faces, max(inner, key=len)


def run(edges: tuple[int, ...] = EDGES) -> dict[str, Any]:
    result: dict[str, Any] = {}
    for wanted in edges:
        points, faces, loop = ragged_hole(wanted)
        begun = process_time()
        bare = df.fill_holes(points, faces, holes=[loop], joint="position", density=0)
        entry: dict[str, Any] = {
            "triangulated": process_time() - begun,
            "folds of these": bare.holes[0].folds,
        }
        begun = process_time()
        (hole,) = df.fill_holes(points, faces, holes=[loop]).holes
        entry |= {"filled": process_time() - begun, "faces": len(hole.faces)}
        entry |= {"folds": hole.folds, "energy": hole.energy}
        result[str(len(loop))] = entry
        print(len(loop), entry, flush=True)
    return result


def lengths_table(result: dict[str, Any]) -> str:
    """CPU seconds against the length of a ragged loop."""
    heads = ["edges", "triangles between them alone", "all of it", "new faces", "folds"]
    rows = [
        [
            f"{int(edges):,}",
            f"{table.short(entry['triangulated'])} s",
            f"{table.short(entry['filled'])} s",
            f"{entry['faces']:,}",
            str(entry["folds"]),
        ]
        for edges, entry in result.items()
    ]
    return table.markdown(heads, rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "fill.lengths": lengths_table(result),
    }


if __name__ == "__main__":
    run()
