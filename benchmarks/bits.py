# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that surfaces stay the same to the last bit: hashes of many surfaces, written before a change and
compared after it.

    .venv/bin/python benchmarks/bits.py write before.json
    .venv/bin/python benchmarks/bits.py compare before.json

`--quick` leaves out the collection of real meshes, `--only TEXT` all cases whose name does not
contain the text. `tests/python/surface_hashes.py` compares machines.
"""

import argparse
import hashlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from time import monotonic
from typing import Any

import discrete_fairing as df
import from_tests
import numpy as np

ENERGIES = ("thin_plate", "total_curvature", "minimum_variation")
FEW, MANY = 700, 3000  # faces up to which a real mesh is refined twice, and is run at all
Case = tuple[str, np.ndarray, Any, dict[str, Any]]


def digest(*arrays: np.ndarray) -> str:
    """A short hash of the arrays' bytes."""
    whole = hashlib.sha256()
    for array in arrays:
        whole.update(np.ascontiguousarray(array).tobytes())
    return whole.hexdigest()[:16]


def own_cases() -> Iterator[Case]:
    """The tests' control meshes under every option that changes a surface."""
    meshes = from_tests.small_meshes()
    # rows serve levels of small faces, passes the others, from level 5 on
    closed = {
        "icosahedron": (meshes.icosahedron(), (1, 3, 5)),
        "cube": (meshes.cube(), (1, 2, 5)),
        "torus": (meshes.torus(), (1, 3)),
        "creature": (meshes.creature(), (1, 2)),
        "house": (meshes.mixed_house(), (1, 2, 3)),
    }
    for energy in ENERGIES:
        for name, ((vertices, faces), several) in closed.items():
            for levels in several:
                yield (
                    f"{name} {energy} {levels}",
                    vertices,
                    faces,
                    {
                        "energy": energy,
                        "levels": levels,
                    },
                )
    patch = meshes.wavy_patch()
    vertices, faces = meshes.mixed_house()
    rng = np.random.default_rng(1)
    options: dict[str, dict[str, Any]] = {
        "uniform": {"metric_exponent": 0.0},
        "paper": {"metric_exponent": 1.0},
        "blend": {"chart_blend": 0.5},
        "tangent": {"chart": "tangent", "metric_exponent": 1.0},
        "tolerance": {"interpolation": "approximate", "tolerance": 0.05},
        "weights": {
            "interpolation": "approximate",
            "weights": rng.uniform(0.1, 10.0, len(vertices)),
        },
        "release": {"epsilon": 0.02},
        "creased": {"crease_angle": 0.6},
        "shapes": {"shapes": np.asarray(vertices, float)[None] * (1.0, 0.7, 1.2)},
        "rough": {"relative_residual": 1e-4},
    }
    for energy in ENERGIES:
        for name, chosen in options.items():
            if name == "shapes" and energy == "minimum_variation":
                continue
            if name == "release" and energy != "thin_plate":
                continue
            yield (
                f"house {name} {energy}",
                vertices,
                faces,
                {
                    "energy": energy,
                    "levels": 2,
                    **chosen,
                },
            )
        for boundary in ("curve", "linear", "free"):
            yield (
                f"patch {boundary} {energy}",
                *patch,
                {
                    "energy": energy,
                    "levels": 3,
                    "boundary": boundary,
                },
            )
        for joint in ("position", "tangent", "curvature"):
            yield (
                f"region {joint} {energy}",
                vertices,
                faces,
                {
                    "energy": energy,
                    "levels": 3,
                    "region": np.arange(len(faces) // 2),
                    "joint": joint,
                },
            )
    yield "back leg", vertices, faces, {"method": "back_leg", "levels": 3}


def real_cases() -> Iterator[Case]:
    """Meshes of the collection that may lie beside the project."""
    mesh_files, shared_data = from_tests.readers()
    folder = shared_data.SHARED / "good"
    for path in sorted(p for p in folder.rglob("*") if p.suffix.lower() in mesh_files.SUFFIXES):
        vertices, faces = mesh_files.read_mesh(path)
        if len(faces) > MANY:
            continue
        name = str(path.relative_to(folder).with_suffix(""))
        for energy in ENERGIES:
            levels = 2 if len(faces) <= FEW else 1
            yield f"{name} {energy}", vertices, faces, {"energy": energy, "levels": levels}


def surface_hash(vertices: np.ndarray, faces: Any, options: dict[str, Any]) -> str:
    """A hash of everything that a run returns, energies included."""
    try:
        result = df.fair(
            vertices, faces, **{"pad_size": 0, "relative_residual": 1e-8, "measure": True} | options
        )
    except df.FairingError as error:
        return error.code
    energy = json.dumps(result.report["energy"], sort_keys=True)
    shapes = [np.asarray(shape) for shape in getattr(result, "shapes", ())]
    parts = [result.vertices, result.triangles, *result.faces, *shapes]
    return digest(*parts, np.frombuffer(energy.encode(), np.uint8))


def dragged() -> Iterator[tuple[str, str]]:
    """Hashes of a Solver's surfaces during a drag, and after it was built again at the last positions."""
    vertices, faces = from_tests.small_meshes().creature()
    for energy in ENERGIES[:2]:
        moved = np.array(vertices, float)
        solver = df.Solver(
            moved, faces, levels=2, energy=energy, pad_size=0, relative_residual=1e-8
        )
        for step in range(6):
            moved[step // 3] += (0.01, 0.02, -0.01)
            yield f"drag {energy} {step}", digest(solver.solve(moved).vertices)
        solver.rebase(moved)
        yield f"drag {energy} rebased", digest(solver.solve().vertices)


def hashes(quick: bool, only: str) -> dict[str, str]:
    """The hashes of all cases, by name."""
    found = {}
    cases = [*own_cases(), *([] if quick else real_cases())]
    for name, vertices, faces, options in cases:
        if only in name:
            found[name] = surface_hash(vertices, faces, options)
    found |= {name: value for name, value in dragged() if only in name}
    return found


def main() -> int:
    """Writes or compares hashes; the exit code is 1 if one differs."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", choices=("write", "compare"))
    parser.add_argument("file", type=Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", default="", metavar="TEXT")
    given = parser.parse_args()
    start = monotonic()
    found = hashes(given.quick, given.only)
    print(f"{len(found)} surfaces in {monotonic() - start:.0f} s, {df.__file__}")
    if given.what == "write":
        given.file.write_text(json.dumps(found, indent=1) + "\n")
        return 0
    before = json.loads(given.file.read_text())
    differing = [name for name in found if before.get(name) != found[name]]
    for name in differing:
        print(f"differs: {name}")
    print(f"{len(found) - len(differing)} the same, {len(differing)} not")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
