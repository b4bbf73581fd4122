# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface's normal at each node, and how far arcs and nodes turn in its tangent plane."""

import heapq

import numpy as np

from .network import CHORDS, Network

_FLAT = 0.1  # sine of 6°: directions closer to one line span no plane
_CARRIED = 0.7  # a cosine: how far a normal carried along an arc is trusted


class TangentPlanes:
    """`normals` (n, 3) at nodes, to one side; half-edge 2 k runs along the arc k, 2 k + 1 back."""

    def __init__(self, network: Network) -> None:
        self._arcs = network.arcs
        points = np.array([arc.points for arc in network.arcs]).reshape(-1, CHORDS + 1, 3)
        steps = np.diff(points, axis=1)
        self._along = steps / np.maximum(np.linalg.norm(steps, axis=2), 1e-300)[..., None]
        self._turned = _transport(self._along)
        count = len(network.nodes)
        self.leaving: list[list[int]] = [[] for _ in range(count)]
        for k, arc in enumerate(network.arcs):
            self.leaving[arc.a].append(2 * k)
            self.leaving[arc.b].append(2 * k + 1)
        self.normals = np.zeros((count, 3))
        self._look_one_way()
        self._turns = self._arc_turns()

    def from_node(self, half: int) -> int:
        arc = self._arcs[half // 2]
        return arc.b if half % 2 else arc.a

    def to_node(self, half: int) -> int:
        return self.from_node(half ^ 1)

    def out(self, half: int) -> np.ndarray:
        """The direction in which a half-edge leaves its node."""
        return -self._along[half // 2, -1] if half % 2 else self._along[half // 2, 0]

    def in_order(self, node: int) -> list[int]:
        """The half-edges that leave a node, counter-clockwise seen from outside."""
        normal = self.normals[node]
        first = _cross(normal, _sideways(normal))
        second = _cross(normal, first)
        angles = {
            half: float(np.arctan2(self.out(half) @ second, self.out(half) @ first))
            for half in self.leaving[node]
        }
        return sorted(angles, key=lambda half: angles[half])

    def turn_along(self, half: int) -> float:
        """The turn of a half-edge to the left, in radians: its geodesic curvature."""
        turn = float(self._turns[half // 2])
        return -turn if half % 2 else turn

    def turn_between(self, half: int, after: int) -> float:
        """The turn to the left from the end of `half` into `after`."""
        arriving, leaving = -self.out(half ^ 1), self.out(after)
        normal = self.normals[self.from_node(after)]
        flat = [d - (d @ normal) * normal for d in (arriving, leaving)]
        return float(np.arctan2(normal @ _cross(*flat), flat[0] @ flat[1]))

    def _look_one_way(self) -> None:
        """Orients normals along arcs, those that agree best first [Hoppe and others 1992]."""
        known = np.zeros(len(self.normals), bool)
        planes = [self._plane(node) for node in range(len(known))]
        by_degree = sorted(range(len(known)), key=lambda node: -len(self.leaving[node]))
        for seed in by_degree:
            if known[seed] or not self.leaving[seed]:
                continue
            normal = planes[seed]
            # the degree shows a separate loop
            if not normal.any() and len(self.leaving[seed]) == 2:
                normal = self._of(seed)
            self.normals[seed] = (
                normal if normal.any() else _sideways(self.out(self.leaving[seed][0]))
            )
            known[seed] = True
            heap: list[tuple[float, int, tuple[float, ...]]] = []
            self._offer(heap, seed, known, planes)
            while heap:
                _, node, found = heapq.heappop(heap)
                if not known[node]:
                    self.normals[node] = found
                    known[node] = True
                    self._offer(heap, node, known, planes)

    def _offer(self, heap: list, node: int, known: np.ndarray, planes: list[np.ndarray]) -> None:
        for half in self.leaving[node]:
            other = self.to_node(half)
            if not known[other]:
                rotation = self._turned[half // 2, -1]
                if half % 2:
                    rotation = rotation.T
                carried = rotation @ self.normals[node]
                plane = planes[other]
                agreement = float(carried @ plane)
                normal = plane if agreement >= 0 else -plane
                if not plane.any():
                    normal, agreement = carried, _CARRIED
                heapq.heappush(heap, (-abs(agreement), other, tuple(normal.tolist())))

    def _plane(self, node: int) -> np.ndarray:
        """The normal, of either sign, of the plane through a node's directions; zero on a line."""
        out = np.array([self.out(half) for half in self.leaving[node]]).reshape(-1, 3)
        if len(out) == 2:
            normal = _cross(out[0], out[1])
            size = float(np.linalg.norm(normal))
            return normal / size if size > _FLAT else np.zeros(3)
        if not len(out):
            return np.zeros(3)
        _, widths, axes = np.linalg.svd(out - out.mean(axis=0))
        return axes[2] if widths[1] > _FLAT else np.zeros(3)

    def _of(self, node: int) -> np.ndarray:
        """For a separate loop: the normal of the area that it encloses."""
        loop, half = [], self.leaving[node][0]
        while True:
            arc = self._arcs[half // 2]
            loop.append(arc.points[:0:-1] if half % 2 else arc.points[:-1])
            here = self.to_node(half)
            if here == node:
                break
            half = next(h for h in self.leaving[here] if h != half ^ 1)
        points = np.concatenate(loop)
        points = points - points.mean(axis=0)
        area = np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)
        return area / max(float(np.linalg.norm(area)), 1e-300)

    def _arc_turns(self) -> np.ndarray:
        """(e,): turns about normals that change evenly from one end to the other."""
        if not len(self._arcs):
            return np.zeros(0)
        start = self.normals[[arc.a for arc in self._arcs]]
        end = self.normals[[arc.b for arc in self._arcs]]
        carried = np.einsum("ekij,ej->eki", self._turned, start)
        axis = self._along[:, -1]
        twist = np.arctan2(
            np.einsum("ei,ei->e", axis, np.cross(carried[:, -1], end)),
            np.einsum("ei,ei->e", _flat(carried[:, -1], axis), _flat(end, axis)),
        )
        share = np.arange(CHORDS) / (CHORDS - 1) * twist[:, None]
        normals = carried * np.cos(share)[..., None]
        normals += np.cross(self._along, carried) * np.sin(share)[..., None]
        before, after = self._along[:, :-1], self._along[:, 1:]
        side = np.einsum("eki,eki->ek", normals[:, 1:], np.cross(before, after))
        return np.arctan2(side, np.einsum("eki,eki->ek", before, after)).sum(axis=1)


def _transport(along: np.ndarray) -> np.ndarray:
    """(e, k, 3, 3): rotations without twist from the first of the directions (e, k, 3) to each."""
    found = np.empty((*along.shape, 3))
    found[:, 0] = np.eye(3)
    for k in range(1, along.shape[1]):
        axis = np.cross(along[:, k - 1], along[:, k])
        skew = np.zeros((len(along), 3, 3))
        skew[:, 0, 1], skew[:, 0, 2], skew[:, 1, 2] = -axis[:, 2], axis[:, 1], -axis[:, 0]
        skew -= skew.transpose(0, 2, 1)
        cosine = np.einsum("ei,ei->e", along[:, k - 1], along[:, k])
        step = np.eye(3) + skew + skew @ skew / np.maximum(1 + cosine, 1e-9)[:, None, None]
        found[:, k] = step @ found[:, k - 1]
    return found


def _flat(a: np.ndarray, axis: np.ndarray) -> np.ndarray:
    return a - np.einsum("ei,ei->e", a, axis)[:, None] * axis


def _sideways(a: np.ndarray) -> np.ndarray:
    """A unit vector at right angles to `a`."""
    side = _cross(a, np.eye(3)[int(np.argmin(np.abs(a)))])
    return side / max(float(np.linalg.norm(side)), 1e-300)


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross product of two vectors; NumPy's own takes ten times as long for these."""
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )
