# SPDX-License-Identifier: GPL-3.0-or-later
"""A noisy scan of a known blob, and one cage: how near to the truth are surfaces put onto the scan?

The rivals are those of Blender's users: Subdivision Surface of the cage, shrink-wrapped onto the scan as
it is, and onto the scan after Taubin's filter.
"""

from typing import Any

import discrete_fairing as df
import from_tests  # noqa: F401 - finds the tests' modules
import numpy as np
import rivals
import scans
import table

LEVELS = 2
SIDE = 70  # of the scan: 6 SIDE² quads
SIZE = 4.0  # of the blob, about
NOISES = (0.0, 0.0005, 0.002, 0.005)  # of the size
CAGES = (4, 6)  # pieces of a cube's edge
PASSES = 10  # Taubin's
SEEDS = range(2)


def scanned(noise: float, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points and triangles of a scan of the blob, and the true normals at its points."""
    sphere, quads = scans.cube_sphere(SIDE)
    points = scans.on_blob(sphere * [1.9, 1.2, 1.1])
    normals = scans.normals_of_blob(points)
    off = np.random.default_rng(seed).normal(0, noise * SIZE, (len(points), 1))
    return (
        points + off * normals,
        np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]),
        normals,
    )


def shrinkwrapped(surface: np.ndarray, points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """To the nearest point of the scan's triangles that meet at its nearest vertex, as Shrinkwrap does by
    Nearest Surface Point."""
    order = np.argsort(triangles.ravel(), kind="stable")
    begin = np.searchsorted(triangles.ravel()[order], np.arange(len(points) + 1))
    out = np.empty_like(surface)
    for k, p in enumerate(surface):
        nearest = np.argmin(((points - p) ** 2).sum(1))
        around = points[triangles[order[begin[nearest] : begin[nearest + 1]] // 3]]
        candidates = nearest_on(p, around)
        out[k] = candidates[np.argmin(((candidates - p) ** 2).sum(1))]
    return out


def nearest_on(p: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """(k, 3), nearest to p on each of k triangles."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    foot = p - ((p - a) * normal).sum(1, keepdims=True) * normal
    best, least = foot.copy(), np.zeros(len(a))
    for u, v in ((a, b), (b, c), (c, a)):
        outside = (np.cross(v - u, foot - u) * normal).sum(1) < 0
        share = np.clip(((p - u) * (v - u)).sum(1) / ((v - u) ** 2).sum(1), 0, 1)[:, None]
        on_side = u + share * (v - u)
        far = ((on_side - p) ** 2).sum(1)
        better = outside & ((least == 0) | (far < least))
        best[better], least[better] = on_side[better], far[better]
    return best


def errors(points: np.ndarray, triangles: np.ndarray) -> tuple[float, float]:
    """Distance in thousandths of the size and degrees between normals, root mean square."""
    return (
        1e3 / SIZE * scans.rms(scans.distance_to_blob(points)),
        scans.rms(scans.angles_to_blob(points, triangles)),
    )


def surfaces(pieces: int, noise: float, seed: int) -> dict[str, tuple[float, float]]:
    """The errors of each."""
    cage, faces = scans.blob_cage(pieces, 0.02, seed)
    points, triangles, _ = scanned(noise, seed)
    fitted = df.fit(cage, faces, points, triangles=triangles, levels=LEVELS)
    subdivided, halves = rivals.catmull_clark(cage, faces, LEVELS)
    smooth = df.denoise(points, triangles, passes=PASSES).vertices
    return {
        "scan": errors(points, triangles),
        "shrink-wrapped": errors(shrinkwrapped(subdivided, points, triangles), halves),
        "after Taubin": errors(shrinkwrapped(subdivided, smooth, triangles), halves),
        "fit": errors(fitted.vertices, fitted.triangles),
    }


def run() -> dict[str, Any]:
    """Means over the seeds, by noise and number of faces."""
    result: dict[str, Any] = {}
    for pieces in CAGES:
        for noise in NOISES:
            found = [surfaces(pieces, noise, seed) for seed in SEEDS]
            result[f"{100 * noise:g} % · {6 * pieces**2}"] = {
                name: [float(np.mean([each[name][k] for each in found])) for k in (0, 1)]
                for name in found[0]
            }
    return result


def fit_table(result: dict[str, Any]) -> str:
    """Distances and angles of each surface to the true one."""
    names = list(next(iter(result.values())))
    rows = [
        [label, *(f"{table.short(found[n][0])} · {found[n][1]:.2f}°" for n in names)]
        for label, found in result.items()
    ]
    return table.markdown(["noise · faces", *names], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """Those of the documents, by their names."""
    return {"fit": fit_table(result)}
