# SPDX-License-Identifier: GPL-3.0-or-later
"""Hashes of sixty surfaces, to be compared between machines: four meshes, three energies, five sets of options.

    python tests/python/surface_hashes.py write FILE       on one machine
    python tests/python/surface_hashes.py compare FILE     on the other one

`--arrays` keeps the coordinates too, so that `compare` says by how much the surfaces differ.
"""

import argparse
import hashlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path

import control_meshes as meshes
import discrete_fairing as df
import numpy as np

MESHES = {
    "icosahedron": meshes.icosahedron,
    "house": meshes.mixed_house,
    "patch": meshes.wavy_patch,
    "creature": meshes.creature,
}
ENERGIES = ("thin_plate", "total_curvature", "minimum_variation")
OPTIONS = {
    "default": {},
    "points": {"pad_size": 0},
    "creases": {"crease_angle": 0.6},
    "near": {"interpolation": "approximate", "tolerance": 0.05},
    "free": {"boundary": "free", "metric_exponent": 1.0},
}


def surfaces() -> Iterator[tuple[str, np.ndarray]]:
    """The vertices of each surface, or the code of the error, by the case's name."""
    for name, make in MESHES.items():
        vertices, faces = make()
        for energy in ENERGIES:
            for kind, options in OPTIONS.items():
                try:
                    found = df.fair(vertices, faces, 2, energy=energy, **options).vertices
                except df.FairingError as error:
                    found = np.frombuffer(error.code.encode(), np.uint8)
                yield f"{name} {energy} {kind}", found


def digest(array: np.ndarray) -> str:
    """A short hash of an array's bytes."""
    return hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()[:16]


def difference(a: np.ndarray, b: np.ndarray) -> float:
    """The largest distance between two surfaces, by the size of the first."""
    if a.shape != b.shape or a.ndim != 2:
        return float("inf")
    return float(np.abs(a - b).max() / np.ptp(a, axis=0).max())


def main() -> int:
    """Writes or compares; the exit code is 1 where something differs."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", choices=("write", "compare"))
    parser.add_argument("file", type=Path)
    parser.add_argument("--arrays", action="store_true", help="with the coordinates, in FILE.npz")
    given = parser.parse_args()
    found = dict(surfaces())
    beside = given.file.with_suffix(".npz")
    if given.what == "write":
        hashes = {name: digest(array) for name, array in found.items()}
        given.file.write_text(json.dumps(hashes, indent=1) + "\n", encoding="utf-8")
        if given.arrays:
            np.savez(beside, **found)
        return 0
    before = json.loads(given.file.read_text(encoding="utf-8"))
    differing = [name for name in found if before.get(name) != digest(found[name])]
    arrays = np.load(beside) if given.arrays else {}
    for name in differing:
        by = f" by {difference(arrays[name], found[name]):.1e}" if name in arrays else ""
        print(f"differs{by}: {name}")
    print(f"{len(found) - len(differing)} of {len(found)} have the same bits")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
