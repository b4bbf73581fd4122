# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes whose nearest points are known, scans of them with noise and defects, and cages drawn over them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import from_tests  # noqa: F401 - finds the tests' modules
import numpy as np
import scans
from scipy.spatial import cKDTree

Mesh = tuple[np.ndarray, np.ndarray]  # points and quads
Feet = tuple[np.ndarray, np.ndarray]  # nearest points, and normals there, of length one


POINTS_A_DISC = 20  # five across


@dataclass(frozen=True)
class Shape:
    """`nearest`: from points (n, 3) near it to their feet; `scan`: some 20,000 points on it, exactly;
    `ridge`: points on its crease.
    """

    scan: Mesh
    cage: Mesh
    nearest: Callable[[np.ndarray], Feet]
    options: dict[str, Any] = field(default_factory=dict)  # of fit()
    ridge: np.ndarray | None = None

    @property
    def size(self) -> float:
        return float(np.ptp(self.scan[0], axis=0).max())

    def scanned(self, noise: float, seed: int, kind: str = "white") -> Mesh:
        """Points and triangles of a scan with noise along the normals, a share of the size.

        Kinds: "white"; "correlated": means over discs as wide as five points; "strays": one point in
        twenty off by up to 0.025 of the size; "holes": without the tenth of the points in six balls;
        "uneven": seven times as dense at one end as at the other.
        """
        random = np.random.default_rng(seed)
        points, quads = self.scan
        if kind == "uneven":
            points = self.nearest(self._crowded(points))[0]
        off = random.normal(0, 1, len(points))
        if kind == "correlated":
            off = off[cKDTree(points).query(points, POINTS_A_DISC)[1]].mean(1)
            off /= scans.rms(off)
        off *= noise * self.size
        if kind == "strays":
            off += (
                (random.random(len(points)) < 0.05)
                * random.uniform(-0.025, 0.025, len(points))
                * self.size
            )
        points = points + off[:, None] * self.nearest(points)[1]
        triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        if kind != "holes":
            return points, triangles
        centres = points[random.choice(len(points), 6, replace=False)]
        far = cKDTree(centres).query(points)[0]
        kept = far > np.quantile(far, 0.1)
        return points[kept], (np.cumsum(kept) - 1)[triangles[kept[triangles].all(1)]]

    def _crowded(self, points: np.ndarray) -> np.ndarray:
        """Points moved along x, which stay in order: the ends stay."""
        low, length = points[:, 0].min(), np.ptp(points[:, 0])
        t = (points[:, 0] - low) / length
        return np.column_stack([low + length * (t + 0.75 * t * (1 - t)), points[:, 1:]])

    def near(self, points: np.ndarray, triangles: np.ndarray) -> Mesh:
        """What lies over the shape of a mesh, within 0.03 of the size."""
        feet, normals = self.nearest(points)
        apart = points - feet
        beside = np.linalg.norm(apart - (apart * normals).sum(1)[:, None] * normals, axis=1)
        kept = (np.linalg.norm(apart, axis=1) < 0.03 * self.size) & (beside < 1e-3 * self.size)
        faces = triangles[kept[triangles].all(1)]
        used, corners = np.unique(faces, return_inverse=True)
        return points[used], corners.reshape(-1, 3)

    def errors(self, points: np.ndarray, triangles: np.ndarray) -> tuple[float, float]:
        """Distance in thousandths of the size, and degrees between normals, root mean square. Normals
        are not compared within a hundredth of the size from a crease.
        """
        feet, normals = self.nearest(points)
        smooth = np.ones(len(points), bool)
        if self.ridge is not None:
            smooth = cKDTree(self.ridge).query(points)[0] > 0.01 * self.size
        with np.errstate(invalid="ignore"):  # where a surface has shrunk to a line
            own = np.nan_to_num(scans.vertex_normals(points, triangles))
        cosine = (own * normals).sum(1)
        return (
            1e3 / self.size * scans.rms(np.linalg.norm(points - feet, axis=1)),
            scans.rms(np.degrees(np.arccos(np.clip(cosine[smooth], -1, 1)))),
        )


def shaken(cage: Mesh, nearest: Callable[[np.ndarray], Feet], off: float, seed: int = 0) -> Mesh:
    """A cage as drawn by hand, off the shape by so much along the normals."""
    points, quads = cage
    random = np.random.default_rng(seed)
    return points + off * random.standard_normal((len(points), 1)) * nearest(points)[1], quads


def blob() -> Shape:
    """Five balls, blended into one."""

    def nearest(points: np.ndarray) -> Feet:
        feet = points.copy()
        for _ in range(4):  # to its own foot: the distance and the way to it are to first order
            feet = points - scans.distance_to_blob(points)[:, None] * scans.normals_of_blob(feet)
            feet = scans.on_blob(feet, 5)
        return feet, scans.normals_of_blob(feet)

    sphere, quads = scans.cube_sphere(58)
    scan = scans.on_blob(sphere * [1.9, 1.2, 1.1]), quads
    return Shape(scan, scans.blob_cage(6, 0.02), nearest)


def on_ellipsoid(axes: np.ndarray, points: np.ndarray) -> Feet:
    """p = foot + t (foot / axes²), and the foot is on it [Eberly 2013]: bisected for t."""
    low = -(axes.min() ** 2) * np.ones(len(points)) * (1 - 1e-12)
    high = np.linalg.norm(axes * points, axis=1) + 1
    for _ in range(80):
        t = (low + high) / 2
        outside = ((axes * points / (axes**2 + t[:, None])) ** 2).sum(1) > 1
        low, high = np.where(outside, t, low), np.where(outside, high, t)
    feet = axes**2 * points / (axes**2 + t[:, None])
    normals = feet / axes**2
    return feet, normals / np.linalg.norm(normals, axis=1, keepdims=True)


def lens() -> Shape:
    """An ellipsoid thirty times as wide as high: two sides near one another."""
    axes = np.array([1.5, 1.0, 0.05])

    def nearest(points: np.ndarray) -> Feet:
        return on_ellipsoid(axes, points)

    sphere, quads = scans.cube_sphere(58)
    drawn, cage = scans.cube_sphere(6)
    return Shape((sphere * axes, quads), shaken((drawn * axes, cage), nearest, 0.008), nearest)


def nearest_of(points: np.ndarray, found: Sequence[Feet]) -> Feet:
    """The nearest of several feet of each point."""
    best = np.argmin([np.linalg.norm(points - feet, axis=1) for feet, _ in found], axis=0)
    every = np.arange(len(points))
    return np.stack([f for f, _ in found])[best, every], np.stack([n for _, n in found])[
        best, every
    ]


def ring_edges(quads: np.ndarray, is_on: np.ndarray) -> np.ndarray:
    """(k, 2): the edges whose two ends have `is_on` set."""
    edges = np.stack([quads, np.roll(quads, -1, axis=1)], -1).reshape(-1, 2)
    return np.unique(np.sort(edges[is_on[edges].all(1)], axis=1), axis=0)


def mouse() -> Shape:
    """Two caps of ellipsoids that meet in a sharp parting line, an ellipse."""
    rim, depths, offs = np.array([1.2, 0.7]), (0.8, 0.5), (0.3, 0.35)  # above, below
    sides = [
        (np.array([*rim / np.sqrt(1 - (off / depth) ** 2), depth]), np.array([0, 0, -way * off]))
        for depth, off, way in zip(depths, offs, (1, -1))
    ]
    angle = np.linspace(0, 2 * np.pi, 20000, endpoint=False)
    line = np.stack([rim[0] * np.cos(angle), rim[1] * np.sin(angle), 0 * angle], 1)
    out = line / np.array([*rim**2, 1])
    out /= np.linalg.norm(out, axis=1, keepdims=True)

    def nearest(points: np.ndarray) -> Feet:
        at = cKDTree(line).query(points)[1]
        found = [(line[at], out[at])]
        for (axes, centre), way in zip(sides, (1, -1)):
            feet, normals = on_ellipsoid(axes, points - centre)
            feet = feet + centre
            feet[way * feet[:, 2] < 0] = np.inf
            found.append((feet, normals))
        return nearest_of(points, found)

    def placed(pieces: int) -> Mesh:
        sphere, quads = scans.cube_sphere(pieces)
        points = np.empty_like(sphere)
        for (axes, centre), way in zip(sides, (1, -1)):
            ray, start = sphere * np.array([*rim, 0.6]) / axes, -centre / axes
            # |start + t ray| = 1
            a, b, c = (ray**2).sum(1), ray @ start, start @ start - 1
            t = (-b + np.sqrt(b * b - a * c)) / a
            here = way * sphere[:, 2] >= 0
            points[here] = (t[:, None] * ray * axes)[here]
        return points, quads

    points, quads = placed(6)
    creases = ring_edges(quads, np.abs(points[:, 2]) < 1e-9)
    cage = shaken((points, quads), nearest, 0.02)
    return Shape(placed(58), cage, nearest, {"crease_edges": creases}, line)


@dataclass(frozen=True)
class _Patch:
    """A map from (u, v) in [0, 1]² to space; `closed`: it comes round in both."""

    place: Callable[[np.ndarray, np.ndarray], np.ndarray]
    closed: bool

    def mesh(self, along: int, across: int) -> Mesh:
        """Quads between places at equal distances of u and v."""
        if not self.closed:
            u, v = np.linspace(0, 1, along + 1), np.linspace(0, 1, across + 1)
        else:
            u, v = np.arange(along) / along, np.arange(across) / across
        x, y = np.meshgrid(u, v, indexing="ij")
        ids = np.arange(x.size).reshape(x.shape)
        if self.closed:
            ids = np.pad(ids, ((0, 1), (0, 1)), mode="wrap")
        corners = (ids[:-1, :-1], ids[1:, :-1], ids[1:, 1:], ids[:-1, 1:])
        return self.place(x.ravel(), y.ravel()), np.stack(corners, -1).reshape(-1, 4)

    def nearest(self, points: np.ndarray) -> Feet:
        """Feet by Gauss-Newton steps from the nearest of many samples."""
        u, v = (a.ravel() for a in np.meshgrid(*2 * [np.linspace(0, 1, 401)], indexing="ij"))
        at = cKDTree(self.place(u, v)).query(points)[1]
        u, v, step = u[at], v[at], 1e-6
        for _ in range(12):
            foot = self.place(u, v)
            along = (self.place(u + step, v) - self.place(u - step, v)) / (2 * step)
            across = (self.place(u, v + step) - self.place(u, v - step)) / (2 * step)
            rest = points - foot
            a, b, c = (
                (x * y).sum(1) for x, y in ((along, along), (along, across), (across, across))
            )
            p, q = ((rest * x).sum(1) for x in (along, across))
            determinant = a * c - b * b
            u, v = u + (c * p - b * q) / determinant, v + (a * q - b * p) / determinant
            if not self.closed:
                u, v = np.clip(u, 0, 1), np.clip(v, 0, 1)
        normals = np.cross(along, across)
        return self.place(u, v), normals / np.linalg.norm(normals, axis=1, keepdims=True)


def handle() -> Shape:
    """A body with a thin handle, of genus one."""

    def place(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        a, b = 2 * np.pi * u, 2 * np.pi * v
        tube = 0.38 + 0.2 * np.cos(a)
        out = 1 + tube * np.cos(b)
        return np.stack([out * np.cos(a), out * np.sin(a), 1.3 * tube * np.sin(b)], 1)

    patch = _Patch(place, closed=True)
    return Shape(
        patch.mesh(200, 100), shaken(patch.mesh(24, 10), patch.nearest, 0.02), patch.nearest
    )


def fender() -> Shape:
    """A panel with a wheel arch cut out of its border."""

    def place(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        x = 3 * u - 1.5
        arch = 0.7 * np.exp(-4 * x**2)
        y = -1 + arch + v * (2 - arch)
        return np.stack([x, y, 0.5 * np.cos(0.9 * x) * np.cos(0.8 * y)], 1)

    patch = _Patch(place, closed=False)
    points, quads = patch.mesh(18, 12)
    corners = [0, 12, 18 * 13, 19 * 13 - 1]
    cage = shaken((points, quads), patch.nearest, 0.02)
    return Shape(patch.mesh(160, 125), cage, patch.nearest, {"corner_vertices": corners})


def hull() -> Shape:
    """Half a hull with a sharp chine, from keel to gunwale and from stem to transom."""

    def line(u: np.ndarray, which: int) -> np.ndarray:
        """The points of keel (0), chine (1) or gunwale (2)."""
        fore = 1 - u
        wide, low = 0.25 + 0.38 * (1 - fore**2), 0.25 + 0.25 * fore**2
        y = (0 * u, wide, wide + 0.18)[which]
        return np.stack([3 * u, y, (0.35 * fore**3, low, 0.8 + 0.2 * fore**2)[which]], 1)

    def strip(first: int, out: tuple[float, float]) -> _Patch:
        """Between two lines, bulging by `out` in y and z."""

        def place(u: np.ndarray, v: np.ndarray) -> np.ndarray:
            bulge = np.sin(np.pi * v)[:, None] * np.array([0, *out])
            return (1 - v[:, None]) * line(u, first) + v[:, None] * line(u, first + 1) + bulge

        return _Patch(place, closed=False)

    bottom, side = strip(0, (0.02, -0.06)), strip(1, (0.07, -0.01))

    def both(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        below = (v <= 0.5)[:, None]
        return np.where(below, bottom.place(u, 2 * v), side.place(u, 2 * v - 1))

    def nearest(points: np.ndarray) -> Feet:
        return nearest_of(points, [bottom.nearest(points), side.nearest(points)])

    whole = _Patch(both, closed=False)
    points, quads = whole.mesh(18, 12)
    creases = ring_edges(quads, np.arange(len(points)) % 13 == 6)
    cage = shaken((points, quads), nearest, 0.02)
    options = {"crease_edges": creases, "corner_vertices": [0, 12, 18 * 13, 19 * 13 - 1]}
    return Shape(whole.mesh(160, 126), cage, nearest, options, line(np.linspace(0, 1, 20000), 1))


SHAPES = {
    "blob": blob,
    "handle": handle,
    "fender": fender,
    "thin lens": lens,
    "mouse": mouse,
    "hull": hull,
}
