# SPDX-License-Identifier: GPL-3.0-or-later
"""What of the curves did not take part, and where: a sentence each, the cure in it."""

from collections.abc import Sequence

import numpy as np

from .crossings import Meeting
from .cubics import Curve, points_at
from .network import Loose, Network

_SHOWN = 8


def place_text(place: np.ndarray) -> str:
    return "({:.4g}, {:.4g}, {:.4g})".format(*(0.0 if abs(x) < 1e-9 else x for x in place.tolist()))


def remarks(network: Network) -> list[str]:
    """On loose ends and near misses, and curves without any part in the surface."""
    used = {arc.curve for arc in network.arcs}
    said = [_miss(network, miss) for miss in network.misses]
    for i, curve in enumerate(network.curves):
        if i not in used:
            said.append(
                f"'{curve.name}' encloses nothing, and was left out. {_nearest(network.curves, i, None)}"
            )
    said += [_loose(network, one) for one in network.loose if one.curve in used]
    if len(said) > _SHOWN:
        said[_SHOWN:] = [f"So are {len(said) - _SHOWN} other places."]
    return said


def _miss(network: Network, miss: Meeting) -> str:
    first, second = (network.curves[i].name for i in (miss.a, miss.b))
    return (
        f"'{first}' misses '{second}' by {miss.distance:.3g} near {place_text(miss.place)}: "
        f"move one of them, or raise Snap to {1.05 * miss.distance:.2g}."
    )


def _loose(network: Network, one: Loose) -> str:
    name = network.curves[one.curve].name
    return (
        f"'{name}' ends loose at {place_text(one.place)}: {one.length:.3g} of it was left out. "
        f"{_nearest(network.curves, one.curve, one.place)}"
    )


def _nearest(curves: Sequence[Curve], i: int, place: np.ndarray | None) -> str:
    """What is next to a place, or to the ends of a curve."""
    others = [(k, _samples(curve)) for k, curve in enumerate(curves) if k != i]
    if not others:
        return "There is no other curve."
    ends = points_at(curves[i].pieces, np.array([0.0, curves[i].end])) if place is None else [place]
    gap, k = min(
        (float(np.linalg.norm(points - end, axis=1).min()), k)
        for k, points in others
        for end in ends
    )
    return f"'{curves[k].name}' is {gap:.3g} away from its end: extend it to there, or shorten it."


def _samples(curve: Curve) -> np.ndarray:
    return points_at(curve.pieces, np.linspace(0.0, curve.end, 8 * len(curve.pieces) + 1))


def none_text(network: Network) -> str:
    """Why there is no surface."""
    said = remarks(network)
    start = "The curves enclose nothing: "
    if not network.crossings and len(network.curves) > 1:
        start += f"no two of them come nearer to each other than {network.tolerance:.3g} (Snap). "
    return start + (" ".join(said) or "Draw curves across them, whose ends lie on the others.")
