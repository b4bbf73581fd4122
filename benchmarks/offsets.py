# SPDX-License-Identifier: GPL-3.0-or-later
"""Scattered offsets: the effect of Near and easing on their error, and when strain finds the wrong one. All
inner vertices are off by a normal scatter along the shape's normal. With one more of them off by six times
as much, the most strained one is released. Lengths are in control edges, of hulls in metres.
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
    """A sphere of 162 vertices."""
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


def edge(mesh: Mesh) -> float:
    points, faces = mesh
    return float(np.linalg.norm(points[faces] - points[np.roll(faces, 1, axis=1)], axis=-1).mean())


def inside(mesh: Mesh) -> np.ndarray:
    """The vertices off the border."""
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
    """The errors of one trial, in the mesh's unit."""
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
    """Whether the wrong vertex is the most strained, and the share of the way that it goes back when the
    worst is released; NaN if that is another vertex.
    """
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


def means(trials: list[dict[str, Any]]) -> dict[str, Any]:
    return {name: np.mean([trial[name] for trial in trials], axis=0).tolist() for name in trials[0]}


def run() -> dict[str, Any]:
    """Measures each shape and scatter: a row each."""
    result: dict[str, Any] = {}
    for name, make in MESHES.items():
        mesh = make()
        unit = edge(mesh)
        clean = df.ease(*mesh, **ONE).moves.max() / unit
        lengths = OF_HULLS if name.startswith("hull") else tuple(s * unit for s in SCATTERS)
        for scatter, length in zip(OF_HULLS if lengths is OF_HULLS else SCATTERS, lengths):
            mean = means([errors_of(mesh, length, seed) for seed in range(SEEDS)])
            tried = [planted_in(mesh, length, seed) for seed in range(SEEDS)]
            found = sum(hit for hit, _ in tried)
            share = float(np.nanmedian([back for _, back in tried])) if found else None
            best = min(mean["amount"])
            result[f"{name}, {scatter}"] = mean | {
                "edge": unit, "clean_move": clean, "found": found, "moved_back": share,
                "ratio": mean["automatic"] / best,
            }  # fmt: skip
    return {"shapes": result, "hulls": hulls()}


def hulls() -> dict[str, Any]:
    """Measures each net and scatter: a row each."""
    found = {
        f"{stations} x {lines}, {scatter:g}, {'half' if half else 'open'}": planted_in_hull(
            stations, lines, scatter, half
        )
        for stations, lines in NETS
        for scatter in OF_NETS
        for half in (False, True)
    }
    return found


def offsets_table(result: dict[str, Any]) -> str:
    """Scattered control vertices, eased: errors in thousandths of an edge."""
    rows = []
    for name, found in result["shapes"].items():
        errors = (
            found["before"],
            min(found["near"]),
            min(found["tolerance"]),
            min(found["amount"]),
            found["automatic"],
        )
        back = "–" if found["moved_back"] is None else f"{found['moved_back']:.2f}"
        cells = [f"{1e3 * e / found['edge']:.1f}" for e in errors]
        ratio, noise = f"{found['ratio']:.2f}", f"{found['noise']:.2f}"
        rows.append([name, *cells, ratio, noise, str(found["found"]), back])
    return table.markdown(
        ["shape, scatter", "as measured", "Near", "within a tolerance", "best amount", "automatic"]
        + ["over best", "scatter read", "found of 20", "back"],
        rows,
    )


def offsets_hulls_table(result: dict[str, Any]) -> str:
    """Three wrong vertices of half a hull: how many are among the most strained."""
    rows = [
        [name, *(f"{each[k]:.2f}" for k in ("found", "of_six"))]
        + [f"{1e3 * each[k]:.1f}" for k in ("largest", "median")]
        for name, each in result["hulls"].items()
    ]
    heads = [
        "stations × lines, scatter in m, border at the keel",
        "of the worst 3",
        "of the worst 6",
    ]
    return table.markdown([*heads, "largest strain without scatter, mm", "median, mm"], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "offsets": offsets_table(result),
        "offsets.hulls": offsets_hulls_table(result),
    }


if __name__ == "__main__":
    run()
