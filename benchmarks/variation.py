# SPDX-License-Identifier: GPL-3.0-or-later
"""What minimum variation costs beside total curvature: default settings, processor time on one
thread, in turns.

    .venv/bin/python benchmarks/variation.py --beside FOLDER

runs the package in FOLDER too, an earlier version's site-packages, each mesh with both versions one
after the other, and compares their surfaces.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import control_meshes as meshes
import discrete_fairing as df
import energies
import from_tests
import jobs
import numpy as np
import pads
import table
import timing

REPEATS = 2  # after one that warms up
LEVELS = (3, 4, 5, 6)
MOST_POINTS = 150_000  # of a surface that is run
SPHERE_LEVELS = (7, 8)  # of the tetrahedron
ENERGIES = ("thin_plate", "total_curvature", "minimum_variation")
MESHES = {
    "fender": pads.fender,
    "bonnet": lambda: jobs.grid(jobs.MODELS["bonnet"][1]),
    "hull": partial(meshes.hull, 40),
    "bob": partial(energies.collected, "bob_small.ply"),
    "cat head": partial(energies.collected, "cat_head.obj"),
    "tetrahedron": lambda: from_tests.small_meshes().tetrahedron(),
}


def cases() -> Iterator[tuple[str, int]]:
    """Meshes that are there and levels, as far as the surfaces are not too large."""
    for name, make in MESHES.items():
        mesh = make()
        if mesh is None:
            continue
        triangles = sum(len(face) - 2 for face in mesh[1])
        for levels in SPHERE_LEVELS if name == "tetrahedron" else LEVELS:
            if triangles * 4**levels / 2 <= MOST_POINTS:
                yield name, levels


def measure(name: str, levels: int, surface: Path | None = None) -> dict[str, Any]:
    """Seconds of each energy and what minimum variation took; its points go to `surface`, a file."""
    vertices, faces = MESHES[name]()
    run = partial(df.fair, vertices, faces, levels=levels, threads=1, repair="mend")
    turns = timing.in_turns({energy: partial(run, energy=energy) for energy in ENERGIES}, REPEATS)
    seconds = {energy: turns[energy]["processor"]["min"] for energy in ENERGIES}
    last = turns["minimum_variation"]["last"]
    finest = last.report["curvature"][-1]
    if surface:
        np.save(surface, last.vertices)
    return {
        **seconds,
        "ratio": seconds["minimum_variation"] / seconds["total_curvature"],
        "variation": float(finest["variation"]),
        "converged": bool(finest["converged"]),
        "work": {key: int(count) for key, count in finest["work"].items()},
    }


def measure_in(package: Path | None, name: str, levels: int, surface: Path) -> dict[str, Any]:
    """measure() by a process of its own, with the package in that folder; None: with this one."""
    path = {"PYTHONPATH": str(package)} if package else {}
    words = [sys.executable, "-W", "ignore", __file__, "--one", name, str(levels), str(surface)]
    done = subprocess.run(
        words, env={**os.environ, **path}, check=True, text=True, stdout=subprocess.PIPE
    )
    measured: dict[str, Any] = json.loads(done.stdout)
    return measured


def compare(package: Path, name: str, levels: int) -> dict[str, Any]:
    """Both versions, and how far the surfaces are apart, in sizes of the mesh."""
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder) / "before.npy", Path(folder) / "now.npy"]
        before = measure_in(package, name, levels, files[0])
        now = measure_in(None, name, levels, files[1])
        surfaces = [np.load(file) for file in files]
    size = np.ptp(surfaces[0], axis=0).max()
    apart = np.linalg.norm(surfaces[0] - surfaces[1], axis=1).max() / size
    return {**now, "before": before, "apart": float(apart)}


def show(result: dict[str, Any]) -> None:
    """The table; with an earlier version's figures where they are there."""
    heads = ["mesh, levels", *ENERGIES, "ratio", "steps", "iterations", "factors"]
    rows = []
    for name, entry in result.items():
        row = [name, *(entry[key] for key in (*ENERGIES, "ratio"))]
        row += [entry["work"][key] for key in ("steps", "iterations", "factors")]
        if "before" in entry:
            was = entry["before"]
            row += [was["minimum_variation"], was["ratio"], entry["apart"]]
            row += [entry["variation"] / was["variation"] if was["variation"] else 1.0]
        rows.append(row)
    if any("before" in entry for entry in result.values()):
        heads += ["before", "its ratio", "apart", "variation, by before's"]
    table.show("Minimum variation: seconds of one processor, over total curvature's", heads, rows)


def run(beside: Path | None = None) -> dict[str, Any]:
    """All meshes that are there; `beside`: the folder of another version of the package."""
    result = {}
    for name, levels in cases():
        one = compare(beside, name, levels) if beside else measure(name, levels)
        result[f"{name}, {levels}"] = one
    show(result)
    return result


def main() -> None:
    """With another version beside this one; or one measurement, for such a run."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--beside", type=Path, metavar="FOLDER")
    parser.add_argument("--json", type=Path, metavar="FILE", help="where to write the figures")
    parser.add_argument("--one", nargs=3, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.one:
        name, levels, surface = given.one
        print(json.dumps(measure(name, int(levels), Path(surface))))
        return
    result = run(given.beside)
    if given.json:
        given.json.write_text(json.dumps({"result": result}, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
