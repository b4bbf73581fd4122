# SPDX-License-Identifier: GPL-3.0-or-later
"""A border that meets a neighbour's: fair() with `neighbour`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..converters import vertex_pairs
from ..errors import fairing_error
from ..halves import Control
from .border_fits import BorderFits, border_of
from .borders import Border, Foot, Halfway, border_edges, mesh_arrays
from .turning import Strip, Turning, closed_faces, needed

# Ends nearer to the neighbour's border than this share of a border edge lie on it.
NEAR = 0.05
# Most passes. With curvature, two halves of a bottle of 60 faces, which meet at 34 degrees before, need 16; a hull's
# triangles need 16 or more, since rounding changes their number. Passes end once a change is this share of all.
PASSES = {"tangent": 4, "curvature": 24}
RANKS = ("position", "tangent", "curvature")
SETTLED = 1e-5
# Radians: larger kinks that are left show that the passes diverge. With curvature a surface gets spikes before
# that shows: two bonnets half way on level 4 kept 4e-4, those without spikes at most 8e-5.
LEFT = {"tangent": float(np.radians(1)), "curvature": 2e-4}
# Largest fold beside a border with curvature, over that with tangents, from which it counts as jagged. Of 36 joints it is
# 0.6 to 2.3 but where curvatures alternate from vertex to vertex: 2.5 to 47.
JAGGED = 2.4


class MatchedBorder:
    """A border that meets a neighbour's, of one control mesh or of the same with moved vertices."""

    def __init__(
        self,
        control: Control,
        neighbour: tuple[ArrayLike, Any],
        border: ArrayLike | None = None,
        halfway: bool = False,
        shapes: int = 0,
    ):
        """`border`: (k, 2) vertex pairs, None: the edges whose ends lie on the neighbour's border. `halfway`:
        towards the mean of both. Raises FairingError for settings that exclude a neighbour.
        """
        refused = {
            "shapes": shapes > 0,
            "region": control.settings.get("region") is not None,
            "levels below 2": int(control.settings["levels"]) < 2,
        }
        for name, given in refused.items():
            if given:
                raise fairing_error("BAD_OPTION", f"neighbour does not go with {name}.")
        beside, half = mesh_arrays(neighbour), control.half
        if half:
            beside = half.beside(*beside)
            border = None if border is None else half.with_images("border", "vertex", border)
        self.control, self.border, self.halfway = control, border, halfway
        self.other = border_of(*beside)
        self.joint = control.settings.get("joint", "tangent")
        self.edges = border_edges(control.corners, control.offsets)[0]
        self.chosen: np.ndarray | None = None  # of the edges, those that `strip` and `fits` are for
        self.ends: np.ndarray | None = None  # of the edges, in the last surface
        # by kind of joint, the last surface's angles and normals, from which the next begins
        self.last: dict[str, tuple[np.ndarray, np.ndarray]] = {}

    def meet(self, found: dict[str, Any]) -> None:
        """Changes the points of the core's result `found`."""
        points = found["vertices"]
        now = points[: len(self.control.points)][self.edges]
        if self.ends is None or not np.array_equal(now, self.ends):
            self.ends, chosen = now, _chosen(now, self.edges, self.other, self.border)
            if self.chosen is None or not np.array_equal(chosen, self.chosen):
                self.strip = Strip(
                    closed_faces(found, 1 << self.control.options.levels), self.edges[chosen]
                )
                _, corners, offsets = mesh_arrays((points, (found["triangles"], found["quads"])))
                self.fits = BorderFits(corners, offsets, self.strip.on)
                self.chosen, self.last = chosen, {}
        own, joint = self.fits.of, self.joint
        goal = Halfway(own(points), self.other) if self.halfway else self.other
        found["vertices"] = points = self.strip.placed(points, self.fits.curve_of(points), goal)
        if joint == "position":
            return
        start = own(points)
        foot = goal.at(start.point)
        turn, name = _kink(needed(start, foot)), "position"
        folds = {}  # by kind of joint, the largest beside the border
        last, self.last = self.last, {}
        for better in RANKS[1 : RANKS.index(joint) + 1] if turn < np.pi / 2 else ():
            turning = self.strip.turning(points, start, better)
            none = np.zeros(turning.size), start.normal
            for first in [last[better], none] if better in last else [none]:
                angles, kink, settled = self._turned(turning, foot, first, PASSES[better])
                if kink <= LEFT[better]:
                    break
            met = turning.points(angles)
            folds[better] = self.strip.largest_fold(met)
            if kink > LEFT[better] or folds[better] > folds["tangent"] + np.pi / 2:
                self.fits.up = start.normal
                break
            found["vertices"], name = met, better
            if settled:
                self.last[better] = angles, self.fits.up
        if name != joint:
            on = np.isin(found["crease_edges"], self.strip.on)
            creased = found["crease_edges"][on & ~on[:, ::-1]]
            found["report"]["warnings"].append(_not_met(turn, name, creased))
        elif folds[joint] > JAGGED * folds["tangent"]:
            found["report"]["warnings"].append(_jagged(folds[joint], folds["tangent"]))

    def _turned(
        self, turning: Turning, foot: Foot, first: tuple[np.ndarray, np.ndarray], passes: int
    ) -> tuple[np.ndarray, float, bool]:
        """The angles to the neighbour, from the `first`, given with normals; the largest kink, radians; and
        whether they have settled.
        """
        angles, self.fits.up = first
        kinks: list[float] = []

        def change(at: np.ndarray) -> np.ndarray:
            own = self.fits.of(turning.points(at))
            wanted = needed(own, foot)
            kinks.append(_kink(wanted))
            return turning.change(at, own, wanted)

        angles, settled = _settled(angles, change, turning.moves, passes)
        if not settled:
            kinks.append(_kink(needed(self.fits.of(turning.points(angles)), foot)))
        return angles, kinks[-1], settled


def _kink(wanted: tuple[np.ndarray, np.ndarray]) -> float:
    """The largest of turns from needed(), radians."""
    return float(np.abs(wanted[0]).max())


def _not_met(turn: float, name: str, creased: np.ndarray) -> dict[str, Any]:
    """The warning of a joint that meets with `name` only, since the surface would have to turn by too
    much, or since creases end on it at the vertices `creased`.
    """
    if len(creased):
        return {
            "code": "JOINT_NOT_MET",
            "kind": "vertex",
            "elements": np.unique(creased).tolist(),
            "cause": "A crease ends on the border that is to meet the neighbour's, at {vertex}: the edge between them "
            "stays.",
            "cure": "Give the crease a weight below 1 there, or end it one face before.",
        }
    stays = {"position": "the edge between them stays", "tangent": "their curvatures differ"}[name]
    return {
        "code": "JOINT_NOT_MET",
        "kind": "mesh",
        "elements": [],
        "cause": f"The border turns by {np.degrees(turn):.0f} degrees from the neighbour's, too much for its faces: the two "
        f"meet, but {stays}.",
        "cure": "To change that, let both change, each by half, or use more levels.",
    }


def _jagged(fold: float, smooth: float) -> dict[str, Any]:
    return {
        "code": "JOINT_JAGGED",
        "kind": "mesh",
        "elements": [],
        "cause": f"With the neighbour's curvature the surface has ripples beside the border: its faces fold by "
        f"{np.degrees(fold):.0f} degrees, with its tangents by {np.degrees(smooth):.0f}.",
        "cure": "Take the joint Tangent, or let both change, each by half.",
    }


def _settled(
    at: np.ndarray,
    change: Callable[[np.ndarray], np.ndarray],
    size: Callable[[np.ndarray], np.ndarray],
    passes: int,
) -> tuple[np.ndarray, bool]:
    """The vector at which `change` vanishes, by Anderson's acceleration, and True; without convergence that
    with the least change. `size`, linear: a change's size is the norm of its.
    """
    seen: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    found = []
    for _ in range(passes):
        step = change(at)
        seen.append((at, step, size(step)))
        after = at + step
        turns = [[v - u for u, v in zip(a, b)] for a, b in zip(seen, seen[1:])]
        if turns:
            normal = [[np.sum(a[2] * b[2]) for b in turns] for a in turns]
            right = [np.sum(a[2] * seen[-1][2]) for a in turns]
            weights = np.linalg.lstsq(normal, right, rcond=1e-12)[0]
            after = after - sum(
                w * (moved + turned) for w, (moved, turned, _) in zip(weights, turns)
            )
        at = after
        found.append((float(np.sum(seen[-1][2] ** 2)), after))
        if found[-1][0] <= SETTLED**2 * np.sum(size(after) ** 2):
            return after, True
    return min(found, key=lambda one: one[0])[1], False


def _chosen(
    ends: np.ndarray, edge: np.ndarray, other: Border, border: ArrayLike | None
) -> np.ndarray:
    """(b,) the border edges with `ends` (b, 2, 3) that meet the neighbour: the given ones, or all whose ends
    lie on its border.
    """
    if border is not None:
        pairs = np.sort(vertex_pairs("border", border), axis=1)
        size = max(int(edge.max()), int(pairs.max(initial=0))) + 1
        named = np.isin(np.sort(edge, axis=1) @ [size, 1], pairs @ [size, 1])
    else:
        middle = other.at(ends.mean(axis=1)).point
        gap = np.linalg.norm(other.at(ends.reshape(-1, 3)).point - ends.reshape(-1, 3), axis=1)
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        named = (gap.reshape(-1, 2) <= NEAR * length[:, None]).all(axis=1)
        named &= np.linalg.norm(middle - ends.mean(axis=1), axis=1) <= length / 4
    if not named.any():
        raise fairing_error(
            "BAD_OPTION",
            "No border edge meets the neighbour.",
            cure="Move the border's vertices onto the neighbour's border, within a twentieth of an edge.",
        )
    return np.asarray(named)
