# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests ask of a refined surface."""

from collections import Counter

import numpy as np
from scipy.spatial import cKDTree


def size_of(points) -> float:
    """Diagonal of the bounding box."""
    return float(np.linalg.norm(np.ptp(np.asarray(points), axis=0)))


def as_lists(faces) -> list[list[int]]:
    return [[int(v) for v in face] for face in faces]


def output_faces(result) -> list[list[int]]:
    """All faces of a result, triangles first."""
    triangles, quads = result.faces
    return triangles.tolist() + quads.tolist()


def half_edges(faces) -> Counter:
    """How often each directed edge comes."""
    return Counter((a, b) for face in faces for a, b in zip(face, [*face[1:], face[0]]))


def boundary_loops(faces) -> int:
    """Number of boundary curves of a manifold."""
    directed = half_edges(faces)
    after = {b: a for a, b in directed if (b, a) not in directed}
    loops = 0
    while after:
        v = next(iter(after))
        while v in after:
            v = after.pop(v)
        loops += 1
    return loops


def euler_characteristic(faces) -> int:
    edges = {tuple(sorted(e)) for e in half_edges(faces)}
    return len({v for face in faces for v in face}) - len(edges) + len(faces)


def assert_same_positions(found: np.ndarray, expected: np.ndarray, tolerance: float) -> None:
    """Every point of either has one of the other near by."""
    for some, others in ((found, expected), (expected, found)):
        distance, _ = cKDTree(others).query(some)
        assert distance.max() <= tolerance, distance.max()


def assert_same_points(found: np.ndarray, expected: np.ndarray, tolerance: float) -> None:
    """The same set of points, each point once, whatever the order."""
    assert found.shape == expected.shape
    distance, partner = cKDTree(expected).query(found)
    assert distance.max() <= tolerance, distance.max()
    assert len(np.unique(partner)) == len(expected)


def random_rotation(seed: int) -> np.ndarray:
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


def boundary_vertices(faces) -> np.ndarray:
    directed = half_edges(faces)
    return np.unique([v for e in directed if e[::-1] not in directed for v in e])


def comes_near(level: dict) -> bool:
    """Whether a level's steps ended where a full step gains below a thousandth of the energy, or where
    two damped ones have gained below a two-hundredth, converged or not; `level`: an entry of
    report["curvature"], on point forces."""
    last = level["steps"][-1]
    if level["kept_start"] or last["length"] == 0:
        return False
    return last["decrement"] <= 3e-2 or (level["damped"] and gains_nothing(level))


def gains_nothing(level: dict) -> bool:
    """Whether a level's last two steps gained below a two-hundredth, with decrement below 0.1."""
    steps = level["steps"]
    return (
        len(steps) > 1
        and steps[-1]["decrement"] < 0.1
        and steps[-2]["energy"] - level["energy"] < 0.005 * level["energy"]
    )
