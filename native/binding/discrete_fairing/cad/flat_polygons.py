# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches that are flat: in CAD each is a plane, and so is an input polygon that was split, whose triangles are
often so narrow that patches fold.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import ranges

SMOOTH = 0  # of edge_kind
FLAT = 1e-9  # of the size: the accuracy of CAD files

Step = tuple[int, bool]  # an edge, and whether it runs forward


@dataclass
class _Flat:
    """A flat polygon or patch: its patches, all their edges, and those around it."""

    patches: np.ndarray
    edges: np.ndarray
    outer: np.ndarray


def mark_flat(
    found: dict[str, Any],
    polygons: np.ndarray,
    points_of: Callable[[int], np.ndarray],
    normal_tolerance: float,
) -> None:
    """Adds `patch_plane` to the core's arrays: (P,) int32, for patches in a plane the number of its first
    polygon, of `polygons` (F,) by control faces, otherwise -1. Only the edges of such a plane are off.
    `points_of` has the refined surface's points of a polygon, (k, 3). Where it is smooth around a plane, the
    patches beside it meet the plane within `normal_tolerance`, radians.
    """
    face_patch = np.repeat(
        np.arange(len(found["patch_face_offsets"]) - 1), np.diff(found["patch_face_offsets"])
    )
    own = polygons[found["patch_faces"][found["patch_face_offsets"][:-1]]]
    found["patch_plane"] = np.full(len(own), -1, np.int32)
    meets = np.nan_to_num(found["angles"]).max(axis=1, initial=0) <= normal_tolerance
    flats = _flat_ones(found, polygons, own, points_of)
    for polygon, flat in _enclosed(found, flats, meets).items():
        found["patch_plane"][flat.patches] = polygon
        inner = np.setdiff1d(flat.edges, flat.outer)
        found["angles"][inner] = found["jumps"][inner] = found["edge_error"][inner] = 0
        found["residual"][flat.patches] = found["turned"][flat.patches] = 0
        faces = found["patch_faces"][np.isin(face_patch, flat.patches)]
        found["face_angle"][faces] = found["lattice_turn"][faces] = 0
        found["face_off"][faces] = found["edge_error"][flat.outer].max()


def _flat_ones(
    found: dict[str, Any],
    polygons: np.ndarray,
    own: np.ndarray,
    points_of: Callable[[int], np.ndarray],
) -> dict[int, _Flat]:
    """Flat polygons of one or several patches, and flat patches of several polygons."""
    offsets = found["patch_face_offsets"]
    of_steps = np.repeat(np.arange(len(own)), np.diff(found["loop_offsets"]))
    flat: dict[int, _Flat] = {}
    for polygon, patches in _patches_by(own).items():
        faces = found["patch_faces"][ranges(offsets[patches], offsets[patches + 1])]
        parts = np.unique(polygons[faces]).tolist()
        if len(patches) > 1 and len(parts) > 1:
            continue
        if not is_flat(np.concatenate([points_of(part) for part in parts]), found["size"]):
            continue
        steps = np.isin(of_steps, patches)
        edges = found["loop_edges"][steps]
        around = outline(edges, found["loop_forward"][steps] > 0, found["edge_vertices"])
        if not around or _crosses_itself(_line(found, around)):
            continue
        outer = np.array([edge for edge, _ in around])
        flat[polygon] = _Flat(patches, edges, outer)
    return flat


def _patches_by(own: np.ndarray) -> dict[int, np.ndarray]:
    """The patches of each polygon."""
    order = np.argsort(own, kind="stable")
    values, begin = np.unique(own[order], return_index=True)
    return dict(zip(values.tolist(), np.split(order, begin[1:])))


def _enclosed(found: dict[str, Any], flat: dict[int, _Flat], meets: np.ndarray) -> dict[int, _Flat]:
    """Those between creases, borders, one another, and edges where both sides meet, (E,) bool."""
    count = len(flat) + 1
    while len(flat) < count:
        count = len(flat)
        used = [found["loop_edges"][:0], *(own.outer for own in flat.values())]
        twice = np.bincount(np.concatenate(used), minlength=len(found["edge_kind"])) > 1
        fine = twice | meets | (found["edge_kind"] != SMOOTH)
        flat = {polygon: own for polygon, own in flat.items() if fine[own.outer].all()}
    return flat


def outline(edges: np.ndarray, forward: np.ndarray, ends: np.ndarray) -> list[Step]:
    """The edges around patches with these `edges` (k,), used `forward` (k,) or not, counter-clockwise;
    `ends` (E, 2) are vertices. Empty if they are not one ring.
    """
    _, first, count = np.unique(edges, return_index=True, return_counts=True)
    free = first[count == 1]
    from_, to = np.where(forward[free, None], ends[edges[free]], ends[edges[free]][:, ::-1]).T
    place = {vertex: k for k, vertex in enumerate(from_.tolist())}
    order = [0] if len(free) else []
    while order and (after := place.get(int(to[order[-1]]), -1)) != 0:
        if after < 0 or len(order) == len(free):
            return []
        order.append(after)
    if len(order) < len(free):
        return []
    return [(int(edges[free[k]]), bool(forward[free[k]])) for k in order]


def _line(found: dict[str, Any], around: list[Step]) -> np.ndarray:
    """(k, 3): the control points of the edges in turn, which are near their curves."""
    offsets = np.concatenate([[0], np.cumsum(found["edge_spans"] + 3)])
    lines = [
        found["edge_points"][offsets[e] : offsets[e + 1]][:: 1 if on else -1] for e, on in around
    ]
    return np.concatenate([line[:-1] for line in lines])


def is_flat(points: np.ndarray, size: float) -> bool:
    """Whether points (k, 3) are in one plane, as accurately as in a CAD file of this size."""
    off = (points - points.mean(axis=0)) @ _axes(points)[2]
    return bool(np.abs(off).max() <= FLAT * size)


def _axes(points: np.ndarray) -> np.ndarray:
    """(3, 3): of their scatter, the largest first."""
    arms = points - points.mean(axis=0)
    return np.linalg.eigh(arms.T @ arms)[1].T[::-1]


def _crosses_itself(line: np.ndarray) -> bool:
    """Whether a closed line in a plane does."""
    a = (line - line.mean(axis=0)) @ _axes(line)[:2].T
    b = np.roll(a, -1, axis=0)

    def side(p: np.ndarray, q: np.ndarray, x: np.ndarray) -> np.ndarray:
        along, arm = (q - p).T, (x - p).T
        return along[0] * arm[1] - along[1] * arm[0]

    return any(
        ((side(p, q, a) * side(p, q, b) < 0) & (side(a, b, p) * side(a, b, q) < 0)).any()
        for p, q in zip(a, b)
    )
