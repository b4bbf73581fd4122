# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume, areas and centroids of a closed mesh, and hydrostatics of the part below a waterplane. Plain
arrays, no Blender.

All are exact for the triangles: triangles that the waterplane cuts are clipped, and volumes are fluxes
through the wet faces of fields that vanish on the waterplane z = 0, so that its own face is not needed
[divergence theorem]. The waterplane's area and moments follow from the projections of the wet faces.
"""

from dataclasses import dataclass

import numpy as np


class NotClosed(ValueError):
    """The mesh has open edges below the waterplane; their number."""


@dataclass(frozen=True)
class Solid:
    """Properties of a whole closed mesh, in its own unit."""

    volume: float
    area: float
    centroid: np.ndarray  # (3,)


@dataclass(frozen=True)
class Hydrostatics:
    """Properties of a floating hull in its own unit; lengths are those of the waterplane."""

    volume: float
    buoyancy: np.ndarray  # (3,) the centre of the displaced volume (LCB, TCB, VCB)
    wetted: float  # area
    waterplane: float  # area
    flotation: float  # x of the waterplane's centroid (LCF)
    transverse: float  # second moment of the waterplane about its centre line
    length: float  # of the waterplane
    beam: float

    @property
    def metacentre(self) -> float:
        """BM, transverse: metacentre above the centre of buoyancy."""
        return self.transverse / self.volume if self.volume else 0.0

    def block_coefficient(self, draught: float) -> float:
        box = self.length * self.beam * draught
        return self.volume / box if box else 0.0


def solid(points: np.ndarray, triangles: np.ndarray) -> Solid:
    """`points` (n, 3), `triangles` (m, 3) outwards; raises NotClosed."""
    opened = open_edges(triangles)
    if len(opened):
        raise NotClosed(len(opened))
    shift = points.mean(axis=0)
    corners = (points - shift)[triangles]
    volume, centre = _volume(corners)
    return Solid(volume, float(_areas(corners)[1].sum()), centre + shift)


def hydrostatics(
    points: np.ndarray, triangles: np.ndarray, draught: float, trim: float = 0.0, pivot: float = 0.0
) -> Hydrostatics:
    """Hydrostatics of a hull with `points` (n, 3) and `triangles` (m, 3) outwards, which floats at z =
    `draught` where x is `pivot`. `trim`: radians, the waterplane rises with x. The hull may be open
    above the waterplane, and may be a half that ends in the plane y = 0. Raises NotClosed.
    """
    turn = np.array([[np.cos(trim), 0, np.sin(trim)], [0, 1, 0], [-np.sin(trim), 0, np.cos(trim)]])
    origin = np.array([pivot, 0.0, draught])
    afloat = (points - origin) @ turn.T
    half = _is_half(afloat, triangles)
    wet, cut = clipped(afloat[triangles])
    volume, centre = _volume(wet)
    vector, area = _areas(wet)
    down = -vector[:, 2]
    middles = 0.5 * (wet + np.roll(wet, -1, axis=1))  # exact for squares
    plane = float(down.sum())
    x, y = middles[:, :, 0], middles[:, :, 1]
    along = float((down * x.mean(axis=1)).sum()) / plane if plane else 0.0
    double = 2.0 if half else 1.0
    if half:
        centre[1] = 0.0
    ends = [np.ptp(cut[:, i]) if len(cut) else 0.0 for i in range(2)]
    return Hydrostatics(
        double * volume,
        turn.T @ centre + origin,
        double * float(area.sum()),
        double * plane,
        float((turn.T @ np.array([along, 0.0, 0.0]) + origin)[0]),
        double * float((down * (y**2).mean(axis=1)).sum()),
        float(ends[0]),
        float(2.0 * np.abs(cut[:, 1]).max(initial=0.0) if half else ends[1]),
    )


def clipped(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parts of triangles (m, 3, 3) below z = 0, (k, 3, 3), and (c, 3) points of the cut."""
    below = corners[:, :, 2] < 0.0
    count = below.sum(axis=1)
    whole, parts, cut = corners[count == 3], [], []
    for kept in (1, 2):
        some, here = corners[count == kept], below[count == kept]
        lone = np.argmax(here == (kept == 1), axis=1)  # the single corner on its side
        a, b, c = (some[np.arange(len(some)), (lone + k) % 3] for k in range(3))
        ab, ca = _crossing(a, b), _crossing(a, c)
        cut += [ab, ca]
        if kept == 1:
            parts.append(np.stack([a, ab, ca], axis=1))
        else:
            parts += [np.stack([ab, b, c], axis=1), np.stack([ab, c, ca], axis=1)]
    return np.concatenate([whole, *parts]), np.concatenate(cut)


def open_edges(triangles: np.ndarray) -> np.ndarray:
    """(k, 2) vertices of directed edges without an opposite edge."""
    sides = (
        np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2)
        .reshape(-1, 2)
        .astype(np.int64)
    )
    most = int(sides.max(initial=0)) + 1
    key, back = sides[:, 0] * most + sides[:, 1], sides[:, 1] * most + sides[:, 0]
    return sides[~np.isin(key, back)]


def _is_half(afloat: np.ndarray, triangles: np.ndarray) -> bool:
    """Whether all open edges below the waterplane lie in the plane y = 0; raises NotClosed for others."""
    opened = afloat[open_edges(triangles)]
    wet = opened[opened[:, :, 2].min(axis=1, initial=np.inf) < 0.0]
    near = 1e-6 * np.ptp(afloat, axis=0).max()
    off = int((np.abs(wet[:, :, 1]) > near).any(axis=1).sum())
    if off:
        raise NotClosed(off)
    return bool(len(wet)) and not (afloat[:, 1].min() < -near and afloat[:, 1].max() > near)


def _crossing(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    share = a[:, 2] / (a[:, 2] - b[:, 2])
    points = a + share[:, None] * (b - a)
    points[:, 2] = 0.0
    return points


def _areas(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m, 3) vectors normal to the triangles, with their areas as lengths; (m,) areas."""
    across = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return across, np.linalg.norm(across, axis=1)


def _volume(corners: np.ndarray) -> tuple[float, np.ndarray]:
    """Volume and centroid (3,) enclosed by the triangles and the plane z = 0."""
    up = _areas(corners)[0][:, 2]
    middles = 0.5 * (corners + np.roll(corners, -1, axis=1))
    volume = float((up * corners[:, :, 2].mean(axis=1)).sum())
    moments = (up[:, None] * (middles * middles[:, :, 2:]).mean(axis=1)).sum(axis=0)
    moments[2] *= 0.5
    return volume, moments / volume if volume else moments
