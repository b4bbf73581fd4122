# SPDX-License-Identifier: GPL-3.0-or-later
"""How far total curvature moves where a mesh is turned and numbered otherwise: cages of the
collection that may lie beside the project, and small shapes of the tests."""

from collections.abc import Iterator
from typing import Any

import discrete_fairing as df
import from_tests
import numpy as np
import table
from scipy.spatial import cKDTree

LEVELS, MANY = 2, 2000  # faces
TRIALS = 3  # the first one only renumbers, the others turn as well
STILL = 2e-5  # of the size: what undamped steps leave
MORE = ("creases/opensubdiv-shapes__catmark_bishop", "creases/opensubdiv-shapes__catmark_car")


def cases() -> Iterator[tuple[str, np.ndarray, list[list[int]]]]:
    """Name, vertices, polygons."""
    mesh_files, shared_data = from_tests.readers()
    good = shared_data.SHARED / "good"
    paths = [p for p in good.rglob("*") if p.suffix.lower() in mesh_files.SUFFIXES]
    for path in sorted(paths):
        name = str(path.relative_to(good).with_suffix(""))
        if name.startswith("cages") or name in MORE:
            vertices, faces = mesh_files.read_mesh(path)
            if len(faces) <= MANY:
                yield name.split("__")[1], vertices, faces
    for name, make in from_tests.small_meshes().ALL.items():
        vertices, small = make()
        yield name, np.asarray(vertices), [[int(v) for v in f] for f in small]


def renumbered(
    vertices: np.ndarray, faces: list[list[int]], seed: int
) -> tuple[np.ndarray, list[list[int]]]:
    """Vertices and faces in another order, every face from another corner on."""
    random = np.random.default_rng(seed)
    place = random.permutation(len(vertices))
    moved = np.empty_like(vertices)
    moved[place] = vertices
    other = []
    for f in random.permutation(len(faces)):
        start = int(random.integers(len(faces[f])))
        other.append([int(place[v]) for v in faces[f][start:] + faces[f][:start]])
    return moved, other


def rotation(seed: int) -> np.ndarray:
    """Of space, at random."""
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


def movement(vertices: np.ndarray, faces: list[list[int]]) -> tuple[list[float], list[Any]]:
    """By trial, in sizes of the mesh; and all results, that of the mesh as it is first."""
    results = [df.fair(vertices, faces, LEVELS, "total_curvature", repair="mend")]
    tree = cKDTree(results[0].vertices)
    size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    moved = []
    for seed in range(TRIALS):
        turn = rotation(seed) if seed else np.eye(3)
        points, other = renumbered(vertices @ turn.T, faces, seed)
        results.append(df.fair(points, other, LEVELS, "total_curvature", repair="mend"))
        back = results[-1].vertices @ turn
        apart = max(tree.query(back)[0].max(), cKDTree(back).query(results[0].vertices)[0].max())
        moved.append(float(apart) / size)
    return moved, results


def run() -> dict[str, Any]:
    """Every case, and how many move."""
    out: dict[str, Any] = {}
    rows = []
    for name, vertices, faces in cases():
        try:
            moved, results = movement(vertices, faces)
        except df.FairingError as error:
            print(f"renumbering: {name}: {error}")
            continue
        reports = [r.report for r in results]
        damped = [any(level["damped"] for level in r["curvature"]) for r in reports]
        energies = [r["curvature"][-1]["energy"] for r in reports]
        gone = [r["pads"]["gone"] for r in reports]
        out[name] = {"moved": moved, "damped": damped, "energies": energies, "gone": gone}
        apart = max(energies) / min(energies) - 1 if min(energies) > 0 else 0.0
        rows.append([name, len(faces), sum(damped), *moved, energies[0], apart, len(set(gone))])
    heads = ["mesh", "faces", "damped", "renumbered", *["turned"] * (TRIALS - 1)]
    table.show("Moved, in sizes of the mesh", [*heads, "energy", "apart", "pads"], rows)
    for kind in (False, True):
        of_kind = [max(r["moved"]) for r in out.values() if any(r["damped"]) is kind]
        still = sum(m <= STILL for m in of_kind)
        print(f"{'damped' if kind else 'plain'}: {still} of {len(of_kind)} stay within {STILL}")
    return out
