# SPDX-License-Identifier: GPL-3.0-or-later
"""Spline patches of known shapes and real meshes, measured: the table of docs/trades/cad.md.

    PYTHONPATH=build/py python benchmarks/splines.py [names …]

Prints one row a surface: its level, patches, spans a patch, distances over the size, angles between
normals across edges in degrees, and the CPU time of the fit alone. With Open CASCADE
installed, STEP files are read back: validity, solids, free edges, and volume against the patches'.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

import discrete_fairing as df
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "python"))

import control_meshes as shapes
import example_meshes
import step_files
from mesh_files import SUFFIXES, read_mesh
from pads import fender
from shared_data import SHARED
from spline_measures import volume

CURVED = {"energy": "total_curvature"}


def surfaces():
    """(name, mesh, options) of each surface."""
    yield "cube", shapes.cube(), CURVED
    yield "cube, 1e-5", shapes.cube(), {"tolerance": 1e-5, **CURVED}
    yield "octahedron", shapes.octahedron(), CURVED
    yield "octahedron, 1e-5", shapes.octahedron(), {"tolerance": 1e-5, **CURVED}
    yield "random hull", shapes.random_hull(), CURVED
    yield "Clifford torus", shapes.torus(), CURVED
    yield "genus 2", example_meshes.branching(), CURVED
    for name, (mesh, creases) in (
        ("box with creases", shapes.box_with_creases()),
        ("hull with creases", example_meshes.hull()),
    ):
        yield name, mesh, {"crease_edges": creases}
    yield "fender", fender(), CURVED
    yield "fender, corners kept", fender(), {"corner_vertices": [0, 8, 36, 44]}
    yield "fender, straight border", fender(), {"boundary": "linear"}
    mesh, creases = example_meshes.hull()
    corners = {"crease_edges": creases, "corner_angle": 0.1}
    yield "hull, creases with corners", mesh, corners
    yield "three handles", shapes.three_handles(), CURVED
    yield "triangles and quads", shapes.mixed_house(), {}
    folder = SHARED / "good"
    for path in sorted(path for path in folder.rglob("*") if path.suffix.lower() in SUFFIXES):
        yield path.stem, read_mesh(path), {}


def row(name: str, mesh, options) -> str:
    start = time.process_time()
    patches = df.fit_patches(*mesh, force=True, threads=1, **options)
    whole = time.process_time() - start
    result, level = patches.result, patches.levels
    start = time.process_time()
    again = df._native.fit_splines(
        result.vertices,
        *result.faces,
        result.crease_edges,
        np.empty(0, np.int32),
        level,
        patches.tolerance,
        patches.normal_tolerance,
        1,
        df.Monitor(),
        None,
    )
    fit = (time.process_time() - start) / max(len(again["residual"]), 1)
    angle = np.degrees(patches.edge_angles[np.isfinite(patches.edge_angles)])
    share = np.quantile(angle, 0.999) if angle.size else 0
    cells = [
        name,
        f"{level}",
        f"{len(patches)}",
        f"{patches.patch_spans.prod(axis=1).mean():.1f}",
        f"{patches.residual.max() / patches.size:.1e}",
        f"{patches.edge_error.max() / patches.size:.1e}",
        f"{patches.refinement_error.max() / patches.size:.1e}",
        f"{share:.3f} / {angle.max(initial=0):.3f}",
        f"{len(patches.unmet)} / {len(patches.unresolved)}",
        f"{1000 * fit:.1f}",
        f"{whole:.1f}",
    ]
    if step_files.OCP:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "surface.step"
            df.write_step(file, patches, unit="mm")
            cells.append(f"{file.stat().st_size / 1e6:.2f}")
            read = step_files.read(file)
        known = volume(patches)
        cells.append("yes" if read.valid else "NO")
        cells.append(f"{read.solids} / {int(patches.shell_closed.sum())}")
        cells.append(f"{read.free_edges} / {(patches.edge_kind == 2).sum()}")
        cells.append(f"{abs(read.volume / known - 1):.0e}" if patches.shell_closed.all() else "–")
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    wanted = sys.argv[1:]
    for name, mesh, options in surfaces():
        if wanted and not any(name.startswith(word) for word in wanted):
            continue
        try:
            print(row(name, mesh, options), flush=True)
        except df.FairingError as error:
            print(f"| {name} | {error} |", flush=True)


if __name__ == "__main__":
    main()
