# SPDX-License-Identifier: GPL-3.0-or-later
"""Planar sections of a surface and their curvature. Plain arrays, no Blender.

On a smooth surface a section's normal is the surface's, projected to the plane. So its curvature is the
rate at which this normal turns along the section: a first difference of normals, while the polyline
would need a second difference of points on chords.
"""

from dataclasses import dataclass

import numpy as np

from ..curves.chains import chains

_SAME = 1e-4  # relative to a unit normal: corners with a smaller difference share a point
_TOOTH = 0.12  # relative to the surface's diagonal: a tooth of the comb that few exceed


@dataclass(frozen=True)
class Drawn:
    """A mesh as arrays for a graphics card: k points, t triangles."""

    points: np.ndarray  # (k, 3) float32
    normals: np.ndarray  # (k, 3) float32, unit
    triangles: np.ndarray  # (t, 3) int32


def drawn(
    positions: np.ndarray, corners: np.ndarray, corner_normals: np.ndarray, triangles: np.ndarray
) -> Drawn:
    """Arrays from `positions` (n, 3), `corners` (c,) the vertex of each corner, `corner_normals` (c,
    3), and `triangles` (t, 3) of corners.

    Corners at a vertex share a point if they have the same normal; across a sharp edge each has its
    own.
    """
    normals = np.zeros((len(positions), 3), np.float32)
    normals[corners[::-1]] = corner_normals[::-1]  # the last assignment wins
    own = np.flatnonzero((np.abs(corner_normals - normals[corners]) > _SAME).any(axis=1))
    point_of = corners.astype(np.int32)
    point_of[own] = len(positions) + np.arange(len(own), dtype=np.int32)
    return Drawn(
        np.concatenate([positions, positions[corners[own]]]).astype(np.float32, copy=False),
        np.concatenate([normals, corner_normals[own]]).astype(np.float32, copy=False),
        point_of[triangles],
    )


@dataclass(frozen=True)
class Section:
    """One curve, and k points on it, evenly spaced; a closed curve repeats the first point."""

    curve: np.ndarray  # (l, 3) where edges of the mesh cross the plane
    points: np.ndarray  # (k, 3)
    normals: np.ndarray  # (k, 3) unit, in the plane
    curvature: np.ndarray  # (k,) positive if the curve bulges to the side of the normals
    closed: bool

    @property
    def length(self) -> float:
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())


def heights(points: np.ndarray, axis: int, count: int) -> np.ndarray:
    """(count,) positions of planes across `axis` through (n, 3) points, evenly inside."""
    low, high = points[:, axis].min(), points[:, axis].max()
    return low + (high - low) * (np.arange(count) + 0.5) / count


def sections(surface: Drawn, axis: int, count: int) -> list[Section]:
    """The curves in which `count` even planes across `axis` cut the surface; they end at sharp edges."""
    if not len(surface.triangles) or not count:
        return []
    spacing = _mean_edge(surface)
    found = []
    for height in heights(surface.points, axis, count):
        found += _sections_at(surface, axis, float(height), spacing)
    return found


def cut(surface: Drawn, normal: np.ndarray, place: float) -> list[np.ndarray]:
    """Curves (k, 3) where the plane `normal` · p = `place` cuts; closed ones repeat the first."""
    if not len(surface.triangles):
        return []
    frame = np.linalg.svd(normal[None, :])[2]
    frame[0] = normal
    turned = Drawn(surface.points @ frame.T, surface.normals @ frame.T, surface.triangles)
    found = _sections_at(turned, 0, place, _mean_edge(turned))
    return [section.curve @ frame for section in found]


def combs(found: list[Section], diagonal: float, scale: float = 1.0) -> list[np.ndarray]:
    """(k, 3) the ends of each section's teeth, on the convex side, in one scale, of `diagonal`."""
    usual = _usual_curvature(found)
    if usual <= 0.0:
        return [section.points for section in found]
    length = scale * _TOOTH * diagonal / usual
    limit = 4.0 * usual  # higher curvature, such as at an edge, would fill the view
    return [
        s.points + s.normals * (length * np.clip(s.curvature, -limit, limit))[:, None]
        for s in found
    ]


def _usual_curvature(found: list[Section]) -> float:
    """The median of each section's 95th percentile, by length: a tight bow must not flatten all."""
    if not found:
        return 0.0
    bent = np.array([np.percentile(np.abs(section.curvature), 95.0) for section in found])
    order = np.argsort(bent)
    passed = np.cumsum(np.array([section.length for section in found])[order])
    return float(bent[order[np.searchsorted(passed, 0.5 * passed[-1])]])


def segments(lines: list[np.ndarray]) -> np.ndarray:
    """(s, 3) float32 points, two for each segment of the polylines (k, 3), for drawing lines."""
    return _pairs([line[:-1] for line in lines], [line[1:] for line in lines])


def teeth(found: list[Section], ends: list[np.ndarray]) -> np.ndarray:
    """(s, 3) float32 points, two for each tooth, for drawing lines."""
    return _pairs([section.points for section in found], ends)


def _pairs(begins: list[np.ndarray], ends: list[np.ndarray]) -> np.ndarray:
    none = [np.empty((0, 3))]
    pairs = np.stack([np.concatenate(none + begins), np.concatenate(none + ends)], axis=1)
    return pairs.reshape(-1, 3).astype(np.float32)


def _mean_edge(surface: Drawn) -> float:
    a, b, c = (surface.points[surface.triangles[:, i]] for i in range(3))
    return float(np.mean([np.linalg.norm(b - a, axis=1), np.linalg.norm(c - b, axis=1)]))


def _sections_at(surface: Drawn, axis: int, height: float, spacing: float) -> list[Section]:
    above = surface.points[:, axis] >= height
    crossed = surface.triangles[above[surface.triangles].sum(axis=1) % 3 > 0]
    if not len(crossed):
        return []
    # the two of its three edges with one end above
    edges = np.stack([crossed, np.roll(crossed, -1, axis=1)], axis=2)
    cut = above[edges[:, :, 0]] != above[edges[:, :, 1]]
    ends = np.sort(edges[cut], axis=1)
    keys = ends[:, 0].astype(np.int64) * len(surface.points) + ends[:, 1]
    _, first, node = np.unique(keys, return_index=True, return_inverse=True)
    points, normals = _crossings(surface, ends[first], axis, height)
    links = node.reshape(-1, 2)
    return [
        section
        for chain, _ in chains(links, np.zeros(len(links), bool))
        if (section := _resampled(points[chain], normals[chain], axis, spacing)) is not None
    ]


def _crossings(
    surface: Drawn, ends: np.ndarray, axis: int, height: float
) -> tuple[np.ndarray, np.ndarray]:
    """Points (k, 3) on the edges `ends` (k, 2) at the height, and the normals there in the plane."""
    a, b = (surface.points[ends[:, i]].astype(np.float64) for i in range(2))
    share = ((height - a[:, axis]) / (b[:, axis] - a[:, axis]))[:, None]
    points = a + share * (b - a)
    points[:, axis] = height
    normals = (1.0 - share) * surface.normals[ends[:, 0]] + share * surface.normals[ends[:, 1]]
    normals[:, axis] = 0.0
    return points, normals


def _resampled(
    points: np.ndarray, normals: np.ndarray, axis: int, spacing: float
) -> Section | None:
    """A chain as a section with points about `spacing` apart; None if it has no length."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    length = along[-1]
    if length <= 1e-6 * spacing:
        return None
    closed = bool((points[0] == points[-1]).all())
    u, v = (axis + 1) % 3, (axis + 2) % 3
    turn = np.unwrap(np.arctan2(normals[:, v], normals[:, u]))
    count = max(int(round(length / spacing)), 8 if closed else 2)
    even = np.linspace(0.0, length, count + 1)
    path = np.stack([np.interp(even, along, points[:, i]) for i in range(3)], axis=1)
    angle = np.interp(even, along, turn)
    across = np.zeros_like(path)
    across[:, u], across[:, v] = np.cos(angle), np.sin(angle)
    return Section(points, path, across, _rate(path, angle, axis, closed), closed)


def _rate(path: np.ndarray, angle: np.ndarray, axis: int, closed: bool) -> np.ndarray:
    """(k,) the rate at which the normal at `angle` (k,) turns towards the `path` (k, 3), per length."""
    if closed:
        around = angle[-1] - angle[0]
        angles = np.concatenate([[angle[-2] - around], angle, [angle[1] + around]])
        paths = np.concatenate([path[-2:-1], path, path[1:2]])
        turn, way = angles[2:] - angles[:-2], paths[2:] - paths[:-2]
    else:
        turn, way = np.gradient(angle), np.gradient(path, axis=0)
    u, v = way[:, (axis + 1) % 3], way[:, (axis + 2) % 3]
    # the derivative of a unit normal by its angle is the normal rotated by 90 degrees
    ahead = np.cos(angle) * v - np.sin(angle) * u
    return turn * np.sign(ahead) / np.maximum(np.hypot(u, v), np.finfo(float).tiny)
