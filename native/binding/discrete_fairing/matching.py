# SPDX-License-Identifier: GPL-3.0-or-later
"""A border that meets a neighbour's: fair() with `neighbour`.

The surface is changed in the faces along the border. Across each of them, v from 0 on the border to
1 at the far side, Hermite's quintics take what differs from the neighbour at v = 0, position, slope and
curvature, to nothing at v = 1: all control vertices stay, and so do all other faces.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .borders import Border, Foot, border_edges, border_of, mesh_arrays
from .errors import fairing_error
from .halves import Control
from .options import vertex_pairs
from .piecewise.lattice import Lattice

# Share of a border edge: ends that are nearer to the neighbour's border lie on it.
NEAR = 0.05
# On levels 3 and 4 two halves of a bottle of 60 faces meet at 0.04 degrees after four passes; with curvature
# at 0.02 degrees and a jump of 2.6 % after twelve more. Without tangents first, they jump by 103 % at its neck.
PASSES = {
    "position": {"position": 1},
    "tangent": {"tangent": 4},
    "curvature": {"tangent": 4, "curvature": 12},
}


def require_matchable(settings: dict[str, Any], shapes: int) -> None:
    """Refuses what a border with a neighbour does not go with."""
    refused = {
        "shapes": shapes > 0,
        "region": settings.get("region") is not None,
        "levels below 2": int(settings["levels"]) < 2,
    }
    for name, given in refused.items():
        if given:
            raise fairing_error("BAD_OPTION", f"neighbour does not go with {name}.")


def match_border(
    found: dict[str, Any],
    control: Control,
    neighbour: tuple[np.ndarray, np.ndarray, np.ndarray],
    border: ArrayLike | None,
) -> None:
    """Changes the points of what the core has `found` for a mesh. `neighbour`: of
    mesh_arrays(). `border`: (k, 2) vertex pairs, None: the edges whose ends lie on the neighbour's.
    """
    other = border_of(*neighbour)
    points = found["vertices"]
    edge, _ = border_edges(control.corners, control.offsets)
    edge = edge[_chosen(points[: len(control.points)], edge, other, border)]
    faces = _closed_faces(found, 1 << control.options.levels)
    beside = [_beside(faces, a, b) for a, b in edge.tolist()]
    on = np.unique([face.side_ids(side) for face, side in beside])
    _, corners, offsets = mesh_arrays((points, (found["triangles"], found["quads"])))
    for joint, passes in PASSES[control.settings.get("joint", "tangent")].items():

        def change(at: np.ndarray, joint: str = joint) -> np.ndarray:
            own = border_of(at, corners, offsets, only=on)
            return _change(at, faces, edge, beside, own, other, joint)

        points = _settled(points, change, passes)
    found["vertices"] = points


def _settled(
    points: np.ndarray, change: Callable[[np.ndarray], np.ndarray], passes: int
) -> np.ndarray:
    """Where the change is nothing: Anderson's acceleration, since what is fitted at a place depends
    on the changes at the places beside it, most where the joint ends. Between triangles it may not settle:
    then from where the change was least.
    """
    seen: list[tuple[np.ndarray, np.ndarray]] = []
    found = []
    for _ in range(passes):
        step = change(points)
        seen.append((points, step))
        after = points + step
        turns = [(b[0] - a[0], b[1] - a[1]) for a, b in zip(seen, seen[1:])]
        if turns:
            normal = [[np.sum(a * b) for _, b in turns] for _, a in turns]
            right = [np.sum(a * step) for _, a in turns]
            weights = np.linalg.lstsq(normal, right, rcond=1e-12)[0]
            after = after - sum(w * (moved + turned) for w, (moved, turned) in zip(weights, turns))
        points = after
        found.append((float(np.sum(step * step)), after))
    return min(found, key=lambda one: one[0])[1]


def _change(
    points: np.ndarray,
    faces: list[_Face],
    edge: np.ndarray,
    beside: list[tuple[_Face, int]],
    own: Border,
    other: Border,
    joint: str,
) -> np.ndarray:
    """(N, 3): what takes the points to the neighbour. `beside`: face and side of each edge."""
    change = np.zeros_like(points)
    once = np.bincount(edge.ravel()) == 1
    spokes: dict[tuple[int, int], np.ndarray] = {}
    for (a, b), (face, side) in zip(edge.tolist(), beside):
        u, v = _along(face.lattice, side)
        ends = (bool(once[a]), bool(once[b]))
        moved = _Change(points, face, side, own, other, joint, ends)
        change[face.ids] = moved(u / face.lattice.n, v / face.lattice.n)
        spokes |= face.spokes(change, {a, b})
    _change_fans(faces, set(edge.ravel().tolist()), edge, spokes, change)
    return change


@dataclass(frozen=True)
class _Face:
    """A refined control face: its points, in the order of its lattice."""

    lattice: Lattice
    ids: np.ndarray
    corners: list[int]

    def side_ids(self, k: int) -> np.ndarray:
        """(n + 1,): along side k, from its corner on."""
        u, v = _along(self.lattice, k)
        on = np.flatnonzero(v == 0)
        return np.asarray(self.ids[on[np.argsort(u[on])]])

    def spokes(self, change: np.ndarray, vertices: set[int]) -> dict[tuple[int, int], np.ndarray]:
        """By (vertex, end) the change along the sides that leave these vertices, seen from them."""
        out = {}
        for k, v in enumerate(self.corners):
            end = self.corners[(k + 1) % len(self.corners)]
            along = change[self.side_ids(k)]
            if v in vertices:
                out[v, end] = along
            if end in vertices:
                out[end, v] = along[::-1]
        return out


def _closed_faces(found: dict[str, Any], n: int) -> list[_Face]:
    """All control faces, split polygons as they were split."""
    out = []
    for name, quad in (("triangles", False), ("quads", True)):
        lattice = Lattice(n, quad)
        for cells in found[name].reshape(-1, n * n, lattice.size):
            ids = np.empty(len(lattice.i), np.int64)
            ids[lattice.cells] = cells
            out.append(_Face(lattice, ids, ids[lattice.corners].tolist()))
    return out


def _beside(faces: list[_Face], a: int, b: int) -> tuple[_Face, int]:
    """The face that has the side from a to b, and which of its sides that is."""
    for face in faces:
        if a in face.corners:
            k = face.corners.index(a)
            if face.corners[(k + 1) % len(face.corners)] == b:
                return face, k
    raise fairing_error(
        "BAD_OPTION", "A mesh with a neighbour must be free of defects.", cure="Mend it."
    )


def _change_fans(
    faces: list[_Face],
    joint: set[int],
    edge: np.ndarray,
    spokes: dict[tuple[int, int], np.ndarray],
    change: np.ndarray,
) -> None:
    """Faces that have but a vertex on the joint: between the changes along the sides at it."""
    pairs = {frozenset(pair) for pair in edge.tolist()}
    fans: dict[int, dict[int, tuple[_Face, int]]] = {}  # by vertex, by the end of the first side
    for face in faces:
        size = len(face.corners)
        if any(frozenset((face.corners[k - 1], face.corners[k])) in pairs for k in range(size)):
            continue
        for k, v in enumerate(face.corners):
            if v in joint:
                fans.setdefault(v, {})[face.corners[(k + 1) % size]] = (face, k)
    for v, around in fans.items():
        ends = {face.corners[k - 1] for face, k in around.values()}
        for first in [end for end in around if end not in ends]:
            run = [first]
            while run[-1] in around:
                face, k = around[run[-1]]
                run.append(face.corners[k - 1])
            sides = [spokes.get((v, end)) for end in (run[0], run[-1])]
            for place, end in enumerate(run[:-1]):
                face, k = around[end]
                _change_fan(face, k, sides, place / (len(run) - 1), 1 / (len(run) - 1), change)


def _change_fan(
    face: _Face,
    k: int,
    sides: list[np.ndarray | None],
    begin: float,
    width: float,
    change: np.ndarray,
) -> None:
    """One face; sides: the changes along the first and the last side of its run, None: none."""
    n = face.lattice.n
    i, j = _along(face.lattice, k)
    if not face.lattice.quad:
        i = i - j / 2
    r = i + j if not face.lattice.quad else np.maximum(i, j)
    turn = np.where(r > 0, j / np.maximum(i + j, 1), 0)
    share = (begin + width * turn)[:, None]
    row = np.minimum(r, n).astype(int)
    none = np.zeros((n + 1, 3))
    first, last = (none if side is None else side for side in sides)
    moved = (1 - share) * first[row] + share * last[row]
    change[face.ids] = np.where(change[face.ids] == 0, moved, change[face.ids])


class _Change:
    """What takes a face to the neighbour, 0 <= u <= 1 along its border edge and 0 <= v <= 1 across."""

    def __init__(
        self,
        points: np.ndarray,
        face: _Face,
        side: int,
        own: Border,
        other: Border,
        joint: str,
        ends: tuple[bool, bool],
    ):
        """ends: whether the joint ends where the edge does."""
        n = face.lattice.n
        u, v = _along(face.lattice, side)
        ids = [face.ids[v == r][np.argsort(u[v == r])] for r in range(min(n, 4) + 1)]
        rows = [points[row] for row in ids]
        b = rows[0]
        foot = other.at(b)
        share = np.linspace(0, 1, n + 1)[:, None]
        gap = foot.point - b
        self.n, self.b = n, gap - (1 - share) * gap[0] - share * gap[-1]
        self.joint = joint
        along = _derivative(b + self.b)
        d, q = _across(rows, n, face.lattice.quad, along)
        unit = along / np.linalg.norm(along, axis=1, keepdims=True)
        at = own.slot[ids[0]]
        mine = Foot(own.point[at], own.normal[at], own.inward[at], own.bend[at])
        # the rows of a triangle do not reach its sides' ends
        unknown = 1 if face.lattice.quad else 3
        self.d, self.q = _turned(d, q, unit, mine, foot, ends, unknown)

    def __call__(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        b, d, q = (_between(values, u * self.n) for values in (self.b, self.d, self.q))
        v = v[:, None]
        fade = (1 - v) ** 3
        out = fade * (1 + 3 * v + 6 * v * v) * b
        if self.joint == "position":
            return out
        if self.joint == "tangent":
            return out + fade * v * (1 + 7 / 6 * v) * d  # with the curvature of least bending
        return out + fade * v * (1 + 3 * v) * d + fade * v * v / 2 * q


def _across(
    rows: list[np.ndarray], n: int, quad: bool, along: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """First and second derivatives of the surface across the edge, per width of the face."""
    if quad:
        return _one_sided(rows, n)
    # Of a triangle along both of its other sides, as far as the rows reach; its median is their mean.
    reach = n + 2 - len(rows)
    d, q, count = np.zeros_like(along), np.zeros_like(along), np.zeros(n + 1)
    turns = _derivative(along)
    for left in (True, False):
        part = [row[:reach] if left else row[len(row) - reach :] for row in rows]
        slope, turn = _one_sided(part, n)
        at = np.arange(reach) if left else np.arange(n + 1 - reach, n + 1)
        sign = -1 if left else 1
        mixed = _derivative(slope) if reach > 1 else 0 * slope
        d[at] += slope + sign * along[at] / 2
        q[at] += turn + sign * mixed + turns[at] / 4
        count[at] += 1
    filled = np.flatnonzero(count)
    nearest = filled[np.argmin(np.abs(np.arange(n + 1)[:, None] - filled), axis=1)]
    d[filled] /= count[filled, None]
    q[filled] /= count[filled, None]
    return d[nearest], q[nearest]


def _one_sided(rows: list[np.ndarray], n: int) -> tuple[np.ndarray, np.ndarray]:
    """First and second derivatives at the first of rows that are 1/n apart."""
    if len(rows) > 4:
        first, second = (
            np.array([-25, 48, -36, 16, -3]) / 12,
            np.array([35, -104, 114, -56, 11]) / 12,
        )
    else:
        first, second = np.array([-3, 4, -1]) / 2, np.array([1, -2, 1])
    return (
        n * sum(weight * row for weight, row in zip(first, rows)),
        n * n * sum(weight * row for weight, row in zip(second, rows)),
    )


def _turned(
    d: np.ndarray,
    q: np.ndarray,
    unit: np.ndarray,
    mine: Foot,
    foot: Foot,
    ends: tuple[bool, bool],
    count: int,
) -> tuple[np.ndarray, np.ndarray]:
    """What turns d about the border into the neighbour's tangent plane, and gives q its curvature."""

    def across(inward: np.ndarray) -> np.ndarray:
        inward = inward - np.sum(inward * unit, axis=1, keepdims=True) * unit
        return inward / np.linalg.norm(inward, axis=1, keepdims=True)

    def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.sum(a * b, axis=1, keepdims=True)

    before, after = across(mine.inward), -across(foot.inward)  # away from the neighbour
    angle = _steady(np.arctan2(dot(unit, np.cross(before, after)), dot(before, after)), ends, 1)
    cosine, sine = np.cos(angle), np.sin(angle)

    def turned(vectors: np.ndarray) -> np.ndarray:
        stays = dot(vectors, unit) * unit
        return stays + cosine * (vectors - stays) + sine * np.cross(unit, vectors)

    slope, normal = turned(d), turned(mine.normal)
    side = np.sign(dot(normal, foot.normal))
    # Across the border alone: along it both have the same curve, and what is fitted to that would count.
    bends = (
        np.einsum("ki,kij,kj->k", way, of.bend, way)[:, None]
        for way, of in ((before, mine), (after, foot))
    )
    old, new = bends
    return slope - d, turned(q) - q + _steady(side * new - old, ends, count) * dot(
        d, before
    ) ** 2 * normal


def _steady(values: np.ndarray, ends: tuple[bool, bool], count: int) -> np.ndarray:
    """Where the joint ends, with no one tangent: so many values on the line through those before."""
    values, count = values.copy(), min(count, (len(values) - 1) // 2)
    steps = np.arange(count, 0, -1)[:, None]
    for end, row in zip(ends, (values, values[::-1])):
        if end:
            row[:count] = row[count] - steps * (row[count + 1] - row[count])
    return values


def _derivative(b: np.ndarray) -> np.ndarray:
    """By the length of the edge; the edge has len(b) - 1 equal pieces."""
    return np.gradient(b, axis=0, edge_order=2 if len(b) > 2 else 1) * (len(b) - 1)


def _between(values: np.ndarray, place: np.ndarray) -> np.ndarray:
    """The cubic through the four values around each place."""
    last = len(values) - 1
    if last < 3:
        low = np.clip(np.floor(place).astype(int), 0, last - 1)
        t = (place - low)[:, None]
        return (1 - t) * values[low] + t * values[low + 1]
    low = np.clip(np.floor(place).astype(int) - 1, 0, last - 3)
    t = (place - low)[:, None]
    terms = (
        -(t - 1) * (t - 2) * (t - 3) / 6 * values[low],
        t * (t - 2) * (t - 3) / 2 * values[low + 1],
        -t * (t - 1) * (t - 3) / 2 * values[low + 2],
        t * (t - 1) * (t - 2) / 6 * values[low + 3],
    )
    return sum(terms[1:], terms[0])


def _along(lattice: Lattice, side: int) -> tuple[np.ndarray, np.ndarray]:
    """Steps along this side, from the foot of the median in a triangle, and across it."""
    i, j, n = lattice.i, lattice.j, lattice.n
    if lattice.quad:
        return [(i, j), (j, n - i), (n - i, n - j), (n - j, i)][side]
    k, r = [(i, j), (j, n - i - j), (n - i - j, i)][side]
    return k + r / 2, r


def _chosen(
    points: np.ndarray, edge: np.ndarray, other: Border, border: ArrayLike | None
) -> np.ndarray:
    """Which border edges meet the neighbour: those named, or all whose ends lie on its border."""
    if border is not None:
        pairs = np.sort(vertex_pairs("border", border), axis=1)
        size = len(points)
        named = np.isin(np.sort(edge, axis=1) @ [size, 1], pairs @ [size, 1])
    else:
        ends = points[edge]
        middle = other.at(ends.mean(axis=1)).point
        gap = np.linalg.norm(other.at(ends.reshape(-1, 3)).point - ends.reshape(-1, 3), axis=1)
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        named = (gap.reshape(-1, 2) <= NEAR * length[:, None]).all(axis=1)
        named &= np.linalg.norm(middle - ends.mean(axis=1), axis=1) <= length / 4
    if not named.any():
        raise fairing_error(
            "BAD_OPTION",
            "No border edge meets the neighbour.",
            cure="Put the border's vertices on the neighbour's border, or name the edges.",
        )
    return np.asarray(named)
