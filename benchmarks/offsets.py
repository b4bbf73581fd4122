# SPDX-License-Identifier: GPL-3.0-or-later
"""Scattered offsets: what Near and easing do to their error, and when strain finds the wrong one.

All inner vertices are off by a normal scatter along the shape's normal. With one more of them off by
six times as much, the most strained one is let go. Lengths are in control edges, of hulls in metres.
"""

from collections.abc import Callable
from typing import Any

import control_meshes
import discrete_fairing as df
import numpy as np
import pads
import table

SEEDS = 20
SCATTERS = (0.005, 0.02)  # control edges
PLANTED = 6
OF_HULLS = (0.002, 0.005, 0.01)  # metres, on 10
SHARES = (0.5, 1, 2)  # tolerances, over the scatter
AMOUNTS = (0.5, 1, 2, 4, 8, 16, 32, 64)
WRONG = 0.018  # metres: three of a hull's vertices are off by that, to one side or the other
NETS = ((9, 7), (15, 9))  # stations and lines of such hulls
OF_NETS = (0.001, 0.003)  # metres, their scatter
OF_EACH = 20  # vertices of each mesh that are let go
ONE = {"threads": 1, "levels": 2}

Mesh = tuple[np.ndarray, np.ndarray]


def sheet(height: Callable[..., np.ndarray], across: int = 9, along: int = 7) -> Mesh:
    """Quads over a rectangle, an edge 1 long."""
    x, y = np.meshgrid(np.arange(across) * 1.0, np.arange(along) * 1.0, indexing="ij")
    ids = np.arange(x.size).reshape(x.shape)
    faces = np.stack([ids[:-1, :-1], ids[1:, :-1], ids[1:, 1:], ids[:-1, 1:]], -1).reshape(-1, 4)
    z = height((x - x.mean()) / (across - 1), (y - y.mean()) / (across - 1)) * (across - 1)
    return np.stack([x, y, z], -1).reshape(-1, 3), faces


def hull(stations: int = 9, lines: int = 6) -> Mesh:
    """Half a hull of half ellipses, 10 m long; the keel lies in the plane y = 0."""
    along, up = np.meshgrid(
        np.linspace(-1, 1, stations), np.linspace(0, np.pi / 2, lines), indexing="ij"
    )
    beam, depth = 1.5 * (1 - 0.9 * along**2), 1.0 * (1 - 0.3 * along**2)
    points = np.stack([5 * along, beam * np.sin(up), -depth * np.cos(up)], -1).reshape(-1, 3)
    return points, sheet(lambda x, y: 0 * x, stations, lines)[1]


def sphere() -> Mesh:
    """Of 162 vertices."""
    return control_meshes.sphere(4, 0)


def cut(mesh: Mesh) -> Mesh:
    points, quads = mesh
    return points, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def bump(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 0.1 * np.exp(-6 * (x**2 + y**2))


def saddle(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 0.2 * (x**2 - y**2)


def wave(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 0.05 * np.sin(4 * x + 2 * y + 3)


MESHES: dict[str, Callable[[], Mesh]] = {
    "bump": lambda: sheet(bump),
    "saddle": lambda: sheet(saddle),
    "wave": lambda: sheet(wave),
    "bump, triangles": lambda: cut(sheet(bump)),
    "saddle, triangles": lambda: cut(sheet(saddle)),
    "wave, triangles": lambda: cut(sheet(wave)),
    "hull": hull,
    "hull, triangles": lambda: cut(hull()),
    "fender": pads.fender,
    "fender, triangles": lambda: cut(pads.fender()),
    "sphere": sphere,
}


UNEVEN: dict[str, Callable[[], Mesh]] = {
    **{name: MESHES[name] for name in ("bump", "wave, triangles", "hull", "hull, triangles")},
    "fender": pads.fender,
    "sphere": sphere,
    "torus": lambda: control_meshes.quad_torus(12, 8, 0),
    "torus, triangles": lambda: control_meshes.torus(12, 8, 0),
    "random hull": lambda: control_meshes.hull(60),
    "sphere of quads": lambda: control_meshes.quad_sphere(4, 0),
}


def edge(mesh: Mesh) -> float:
    points, faces = mesh
    return float(np.linalg.norm(points[faces] - points[np.roll(faces, 1, axis=1)], axis=-1).mean())


def inside(mesh: Mesh) -> np.ndarray:
    """Vertices on no border."""
    points, faces = mesh
    edges, counts = np.unique(
        np.sort(np.stack([faces, np.roll(faces, 1, axis=1)], -1).reshape(-1, 2), axis=1),
        axis=0,
        return_counts=True,
    )
    return np.setdiff1d(np.arange(len(points)), edges[counts == 1])


def normals(mesh: Mesh) -> np.ndarray:
    points, faces = mesh
    out = np.zeros_like(points)
    corner = points[faces]
    of_face = np.cross(corner[:, 2] - corner[:, 0], corner[:, -1] - corner[:, 1])
    np.add.at(out, faces, of_face[:, None])
    return out / np.linalg.norm(out, axis=1)[:, None]


def error(points: np.ndarray, truth: np.ndarray) -> float:
    """Root mean square distance from the truth."""
    return float(np.sqrt(np.mean(np.sum((points - truth) ** 2, axis=1))))


def errors_of(mesh: Mesh, scatter: float, seed: int) -> dict[str, Any]:
    """One trial's errors, lengths in the mesh's unit."""
    truth, faces = mesh
    random, ids = np.random.default_rng(seed), inside(mesh)
    measured = truth.copy()
    measured[ids] += random.normal(0, scatter, len(ids))[:, None] * normals(mesh)[ids]
    bounds = [share * scatter for share in SHARES]
    automatic = df.ease(measured, faces, **ONE)
    near = [
        df.fair(
            measured, faces, levels=1, threads=1, interpolation="approximate", tolerance=bound
        ).vertices[: len(truth)]
        for bound in bounds
    ]
    return {
        "before": error(measured, truth),
        "near": [error(points, truth) for points in near],
        "tolerance": [
            error(df.ease(measured, faces, tolerance=bound, **ONE).vertices, truth)
            for bound in bounds
        ],
        "amount": [
            error(df.ease(measured, faces, amount=amount, **ONE).vertices, truth)
            for amount in AMOUNTS
        ],
        "automatic": error(automatic.vertices, truth),
        "noise": automatic.noise / scatter,
    }


def planted_in(mesh: Mesh, scatter: float, seed: int) -> tuple[bool, float]:
    """Whether the wrong vertex is the most strained, and how much of the way it goes back when the
    worst is let go; NaN where that is another."""
    truth, faces = mesh
    random, ids = np.random.default_rng(seed), inside(mesh)
    measured, along = truth.copy(), normals(mesh)
    measured[ids] += random.normal(0, scatter, len(ids))[:, None] * along[ids]
    wrong = int(random.choice(ids))
    measured[wrong] = truth[wrong] + PLANTED * scatter * along[wrong]
    eased = df.ease(measured, faces, most=1, **ONE)
    found = bool(eased.moves[wrong] > 0)
    return found, float(eased.moves[wrong] / (PLANTED * scatter)) if found else float("nan")


def planted_in_hull(stations: int, lines: int, scatter: float, half: bool) -> dict[str, float]:
    """How many of three wrong vertices are among the three and the six most strained, means; and what
    the hull strains without scatter, metres. `half`: with its plane of symmetry.
    """
    truth, faces = mesh = hull(stations, lines)
    options: dict[str, Any] = {"threads": 1} | ({"symmetry_plane": "y"} if half else {})
    ids, along = inside(mesh), normals(mesh)
    clean = np.abs(df.strain(truth, faces, **options).excess[ids])
    found = []
    for seed in range(SEEDS):
        random = np.random.default_rng(seed)
        measured = truth.copy()
        measured[ids] += random.normal(0, scatter, len(ids))[:, None] * along[ids]
        wrong = random.choice(ids, 3, replace=False)
        measured[wrong] = (
            truth[wrong] + WRONG * random.choice([-1.0, 1.0], 3)[:, None] * along[wrong]
        )
        worst = df.strain(measured, faces, **options).worst(6)
        found.append([len(np.intersect1d(worst[:3], wrong)), len(np.intersect1d(worst, wrong))])
    three, six = np.mean(found, axis=0)
    return {
        "found": float(three),
        "of_six": float(six),
        "largest": float(np.nanmax(clean)),
        "median": float(np.nanmedian(clean)),
    }


def let_go(points: np.ndarray, faces: Any, vertex: int) -> np.ndarray:
    """The way by which a vertex moves where all but it are held: what strain is, by its definition."""
    weights = np.full(len(points), np.inf)
    weights[vertex] = 0.0
    settings: dict[str, Any] = {"interpolation": "approximate", "relative_residual": 1e-6}
    result = df.fair(points, faces, weights=weights, **settings, **ONE)
    return result.vertices[vertex] - points[vertex]


def against_let_go() -> dict[str, Any]:
    """Of random vertices of ten meshes: how far strain is from a vertex that is let go."""
    rows, all_errors = [], []
    for name, make in UNEVEN.items():
        points, faces = make()
        random = np.random.default_rng(1)
        points = points + 0.1 * edge((points, faces)) * random.normal(size=points.shape)
        found = df.strain(points, faces, threads=1, relative_residual=1e-6)
        held = inside((points, faces))
        held = held[~np.isnan(found.lengths[held])]
        ids = random.permutation(held)[:OF_EACH]
        ways = np.array([let_go(points, faces, vertex) for vertex in ids])
        off = np.linalg.norm(found.ways[ids] - ways, axis=1)
        # of strains that are next to none, a share says nothing
        least = 0.1 * np.linalg.norm(found.ways[held], axis=1).max()
        errors = off / np.maximum(np.linalg.norm(ways, axis=1), least)
        all_errors += errors.tolist()
        rows.append([name, len(ids), *np.quantile(errors, (0.5, 1)), int((errors > 0.05).sum())])
    table.show(
        "Strain against vertices that are let go, relative errors",
        ["mesh", "vertices", "median", "largest", "over 5 %"],
        rows,
    )
    return {
        "vertices": len(all_errors), "largest": max(all_errors),
        "median": float(np.median(all_errors)),
        "within": sum(error <= 0.05 for error in all_errors),
    }  # fmt: skip


def means(trials: list[dict[str, Any]]) -> dict[str, Any]:
    return {name: np.mean([trial[name] for trial in trials], axis=0).tolist() for name in trials[0]}


def run() -> dict[str, Any]:
    """One row a shape and scatter."""
    result: dict[str, Any] = {}
    rows = []
    for name, make in MESHES.items():
        mesh = make()
        unit = edge(mesh)
        clean = df.ease(*mesh, **ONE).moves.max() / unit
        lengths = OF_HULLS if name.startswith("hull") else tuple(s * unit for s in SCATTERS)
        for scatter, length in zip(OF_HULLS if lengths is OF_HULLS else SCATTERS, lengths):
            mean = means([errors_of(mesh, length, seed) for seed in range(SEEDS)])
            tried = [planted_in(mesh, length, seed) for seed in range(SEEDS)]
            found = sum(hit for hit, _ in tried)
            share = float(np.nanmedian([back for _, back in tried])) if found else float("nan")
            best = min(mean["amount"])
            result[f"{name}, {scatter}"] = mean | {
                "edge": unit, "clean_move": clean, "found": found, "moved_back": share,
                "ratio": mean["automatic"] / best,
            }  # fmt: skip
            told = (mean["before"], min(mean["near"]), min(mean["tolerance"]), best)
            rows.append(
                [f"{name}, {scatter:g}", *(1e3 * e / unit for e in told)]
                + [1e3 * mean["automatic"] / unit, mean["automatic"] / best, mean["noise"]]
                + [found, share, 1e3 * clean]
            )
    table.show(
        f"Offsets, means of {SEEDS} seeds, errors in thousandths of a control edge",
        ["shape, scatter", "before", "Near", "by tolerance", "best amount", "automatic"]
        + ["over best", "noise read", f"found of {SEEDS}", "moved back", "clean moves"],
        rows,
    )
    return {"shapes": result, "hulls": hulls(), "let_go": against_let_go()}


def hulls() -> dict[str, Any]:
    """One row a net and scatter."""
    found = {
        f"{stations} x {lines}, {scatter:g}, {'half' if half else 'open'}": planted_in_hull(
            stations, lines, scatter, half
        )
        for stations, lines in NETS
        for scatter in OF_NETS
        for half in (False, True)
    }
    table.show(
        f"Three wrong vertices in half a hull, means of {SEEDS} seeds",
        ["net, scatter", "of the worst 3", "of the worst 6", "largest clean", "median clean, mm"],
        [
            [name, each["found"], each["of_six"], 1e3 * each["largest"], 1e3 * each["median"]]
            for name, each in found.items()
        ],
    )
    return found


if __name__ == "__main__":
    run()
