# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes whose nearest points are known, scans of them with noise, and cages drawn over them."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import from_tests  # noqa: F401 - finds the tests' modules
import numpy as np
import scans
from scipy.spatial import cKDTree

Mesh = tuple[np.ndarray, np.ndarray]  # points and quads
Feet = tuple[np.ndarray, np.ndarray]  # nearest points, and normals there, of length one


@dataclass(frozen=True)
class Shape:
    """`nearest`: from points (n, 3) near it to their feet; `scan`: some 20,000 points on it, exactly."""

    scan: Mesh
    cage: Mesh
    nearest: Callable[[np.ndarray], Feet]
    options: dict[str, Any] = field(default_factory=dict)  # of fit()

    @property
    def size(self) -> float:
        return float(np.ptp(self.scan[0], axis=0).max())

    def scanned(self, noise: float, seed: int) -> Mesh:
        """Points and triangles of a scan with noise along the normals, a share of the size."""
        points, quads = self.scan
        off = np.random.default_rng(seed).normal(0, noise * self.size, (len(points), 1))
        return (
            points + off * self.nearest(points)[1],
            np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]),
        )

    def errors(self, points: np.ndarray, triangles: np.ndarray) -> tuple[float, float]:
        """Distance in thousandths of the size, and degrees between normals, root mean square."""
        feet, normals = self.nearest(points)
        with np.errstate(invalid="ignore"):  # where a surface has shrunk to a line
            own = np.nan_to_num(scans.vertex_normals(points, triangles))
        cosine = (own * normals).sum(1)
        return (
            1e3 / self.size * scans.rms(np.linalg.norm(points - feet, axis=1)),
            scans.rms(np.degrees(np.arccos(np.clip(cosine, -1, 1)))),
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


def lens() -> Shape:
    """An ellipsoid thirty times as wide as high: two sides near one another."""
    axes = np.array([1.5, 1.0, 0.05])

    def nearest(points: np.ndarray) -> Feet:
        # p = foot + t (foot / axes²), and the foot is on it [Eberly 2013]: bisected for t
        low = -(axes.min() ** 2) * np.ones(len(points)) * (1 - 1e-12)
        high = np.linalg.norm(axes * points, axis=1) + 1
        for _ in range(80):
            t = (low + high) / 2
            outside = ((axes * points / (axes**2 + t[:, None])) ** 2).sum(1) > 1
            low, high = np.where(outside, t, low), np.where(outside, high, t)
        feet = axes**2 * points / (axes**2 + t[:, None])
        normals = feet / axes**2
        return feet, normals / np.linalg.norm(normals, axis=1, keepdims=True)

    sphere, quads = scans.cube_sphere(58)
    drawn, cage = scans.cube_sphere(6)
    return Shape((sphere * axes, quads), shaken((drawn * axes, cage), nearest, 0.008), nearest)


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
        """From the nearest of many samples on, by Gauss and Newton."""
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


SHAPES = {"blob": blob, "handle": handle, "fender": fender, "thin lens": lens}
