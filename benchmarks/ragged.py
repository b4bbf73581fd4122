# SPDX-License-Identifier: GPL-3.0-or-later
"""Two hundred ragged holes, cut at random into the closed meshes of the collection that may lie beside
the project: is each closed, by a manifold, without a fold, without crossing anything and without slivers?
"""

import random
from pathlib import Path
from time import process_time
from typing import Any

import discrete_fairing as df
import fill_shapes
import from_tests
import numpy as np
import rivals
import self_intersections
import table

COUNT = 200
# below SHARED/good, and the levels by which it is faired first
MESHES = (
    ("cages/geometry-central__bob_small.ply", 2),
    ("cages/geometry-central__fox.ply", 1),
    ("cages/geometry-central__sphere_small.ply", 2),
    ("cages/cinolib__sphere_coarse.obj", 1),
    ("cages/odedstein-meshes__fish_fish_low_resolution.obj", 1),
    ("cages/odedstein-meshes__spot_spot_low_resolution.obj", 1),
    ("cages/trimesh__fuze.ply", 0),
    ("cages/trimesh__quadknot.obj", 1),
    ("medium/odedstein-meshes__torus_torus.obj", 1),
    ("mechanical/cinolib__bamboo_pen.obj", 0),
    ("mechanical/cinolib__cube_minus_sphere.obj", 0),
    ("mechanical/gpytoolbox__fandisk.obj", 0),
    ("mechanical/trimesh__fandisk.obj", 0),
    ("mechanical/trimesh__round.stl", 0),
)
FACES = (3, 3000)  # taken away, from … to, spread evenly over the logarithm
MOST_TAKEN = 0.25  # of all faces
# how often the newest face goes on, not any: the more, the more ragged
WANDER = (0.0, 0.5, 0.9)
# each fortieth hole is a long one, in this mesh, of which up to so many faces are taken
LONG, LONG_EVERY, LONG_FACES = ("medium/odedstein-meshes__torus_torus.obj", 2), 40, 40_000


def meshes(folder: Path) -> list[tuple[str, np.ndarray, np.ndarray]]:
    """Names, vertices and triangles, those for long holes last."""
    files, _ = from_tests.readers()
    found = []
    for name, levels in (*MESHES, LONG):
        points, polygons = files.read_mesh(folder / name)
        if levels:
            result = df.fair(points, polygons, levels=levels, energy="thin_plate", measure=False)
            points, triangles = result.vertices, result.triangles.astype(np.int64)
        else:
            triangles = rivals.triangulate(points, polygons)
        found.append((Path(name).stem.split("__")[-1], points, triangles))
    return found


def case(number: int, whole: list[tuple[str, np.ndarray, np.ndarray]]) -> Any:
    """Name, a mesh with a hole, and the largest turn of what it was cut into."""
    holes = from_tests.ragged_holes()
    rng = random.Random(number)
    if number % LONG_EVERY == LONG_EVERY - 1:
        name, points, triangles = whole[-1]
        size, wander = LONG_FACES * (number + 1) // COUNT, WANDER[-1]
    else:
        name, points, triangles = whole[number % (len(whole) - 1)]
        low, high = FACES[0], min(FACES[1], MOST_TAKEN * len(triangles))
        size, wander = round(low * (high / low) ** rng.random()), WANDER[number // len(MESHES) % 3]
    own_turn = turns(points, triangles)
    return name, *holes.cut(points, triangles, holes.ragged(triangles, size, rng, wander)), own_turn


def turns(points: np.ndarray, triangles: np.ndarray, first: int = 0) -> float:
    """Degrees: the largest at an edge of a triangle from the `first` on."""
    a, b, degrees = fill_shapes.turns_at_edges(points, triangles)
    return float(degrees[(a >= first) | (b >= first)].max(initial=0.0))


def angles(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(t, 3) degrees at the corners."""
    corner = points[triangles]
    after = np.roll(corner, -1, axis=1) - corner
    before = np.roll(corner, 1, axis=1) - corner
    cosine = (after * before).sum(axis=2)
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(after, before), axis=2), cosine))


def rim_angle(points: np.ndarray, triangles: np.ndarray) -> float:
    """Degrees: the least that the faces at a vertex of the border leave of a full turn. Where that is
    small, no filling can do without a sliver.
    """
    of_faces = np.bincount(triangles.ravel(), angles(points, triangles).ravel(), len(points))
    loops = df.find_holes(points, triangles)
    return float(360.0 - of_faces[np.concatenate(loops)].max())


def judged(points: np.ndarray, triangles: np.ndarray, own_turn: float) -> dict[str, Any]:
    """What came of the holes of one mesh, which without them turns by `own_turn` degrees at most."""
    begun = process_time()
    filled = df.fill_holes(points, triangles)
    seconds = process_time() - begun
    # that no triangles between the vertices of the rim can do without
    bare = df.fill_holes(points, triangles, joint="position", density=0)
    forced = sum(h.folds > 0 for h in bare.holes)
    unforced = sum(
        h.folds > 0 and not b.folds for h, b in zip(filled.holes, bare.holes, strict=True)
    )
    sides = np.sort(filled.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    uses = np.unique(sides, axis=0, return_counts=True)[1]
    before = self_intersections.crossing_triangles(points, triangles)
    after = self_intersections.crossing_triangles(filled.vertices, filled.faces)
    return {
        "edges": sorted((len(loop) for h in filled.holes for loop in h.loops), reverse=True),
        "new faces": len(filled.new_faces),
        "closed": bool((uses == 2).all()),
        "sound": not [d for d in df.check(filled.vertices, filled.faces) if d.severity == "error"],
        "holes": len(filled.holes),
        "folded": sum(h.folds > 0 for h in filled.holes),
        "folds forced": forced,
        "folds not forced": unforced,
        "crossing": int(after - before),
        "said to cross": sum(h.crossings for h in filled.holes),
        "turn": turns(filled.vertices, filled.faces, len(triangles)),
        "own turn": own_turn,
        "least angle": float(angles(filled.vertices, filled.faces[len(triangles) :]).min()),
        "rim angle": rim_angle(points, triangles),
        "made by": sorted({f"{h.energy}, {h.joint}" for h in filled.holes}),
        "seconds": seconds,
    }


def run(numbers: range = range(COUNT)) -> dict[str, Any]:
    """All cases; nothing where the collection is absent."""
    _, shared_data = from_tests.readers()
    folder = shared_data.SHARED / "good"
    if not folder.is_dir():
        print("ragged: the collection of meshes is not here.")
        return {}
    whole = meshes(folder)
    result = {}
    for number in numbers:
        name, points, triangles, own_turn = case(number, whole)
        found = judged(points, triangles, own_turn)
        result[str(number)] = {"mesh": name, **found}
        if (
            found["folds not forced"]
            or found["crossing"]
            or not (found["closed"] and found["sound"])
        ):
            print(number, name, found, flush=True)
    _show(result)
    return result


def _show(result: dict[str, Any]) -> None:
    rows = []
    for name in sorted({r["mesh"] for r in result.values()}):
        of = [r for r in result.values() if r["mesh"] == name]
        rows.append(
            [
                name,
                sum(r["holes"] for r in of),
                max(r["edges"][0] for r in of),
                sum(not r["closed"] for r in of),
                sum(not r["sound"] for r in of),
                *(
                    sum(r[key] for r in of)
                    for key in ("folds not forced", "folded", "folds forced")
                ),
                sum(bool(r["crossing"]) for r in of),
                sum(r["turn"] > max(90.0, r["own turn"]) for r in of),
                min(r["least angle"] for r in of),
                sum(r["made by"] != ["total_curvature, curvature"] for r in of),
            ]
        )
    heads = ["mesh", "holes", "longest", "open", "unsound", "folded, not forced", "folded"]
    heads += [
        "forced to fold",
        "crossing",
        "sharper than the mesh",
        "least angle",
        "otherwise made",
    ]
    table.show("Ragged holes", heads, rows)


if __name__ == "__main__":
    import sys

    run(range(*map(int, sys.argv[1:])))
