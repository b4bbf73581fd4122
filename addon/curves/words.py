# SPDX-License-Identifier: GPL-3.0-or-later
"""Which parts of the curves were left out, and where: a sentence each, with the cure."""

import numpy as np

from ..units import Text
from .crossings import Meeting
from .cubics import Curve, points_at
from .network import Loose, Network

_SHOWN = 8  # as warnings
_TOLD = 3  # in an error


def plain(length: float) -> str:
    """The length without a unit, if there is no scene."""
    return f"{length:.4g}"


def place_text(place: np.ndarray, text: Text) -> str:
    return f"({', '.join(text(0.0 if abs(x) < 1e-9 else x) for x in place.tolist())})"


def remarks(network: Network, text: Text = plain) -> list[str]:
    """Remarks on loose ends, near misses, and curves that are no part of the surface."""
    used = {arc.curve for arc in network.arcs}
    said = [_miss(network, miss, text) for miss in network.misses]
    for i, curve in enumerate(network.curves):
        if i not in used:
            said.append(
                f"'{curve.name}' encloses nothing, and was left out. {_nearest(network, i, None, text)}"
            )
    said += [_loose(network, one, text) for one in network.loose if one.curve in used]
    if len(said) > _SHOWN:
        said[_SHOWN:] = [f"There are {len(said) - _SHOWN} more such places."]
    return said


def _miss(network: Network, miss: Meeting, text: Text) -> str:
    first, second = (network.curves[i].name for i in (miss.a, miss.b))
    return (
        f"'{first}' misses '{second}' by {text(miss.distance)} near {place_text(miss.place, text)}: "
        f"move one of them, or raise Snap to {text(1.05 * miss.distance)}."
    )


def _loose(network: Network, one: Loose, text: Text) -> str:
    name = network.curves[one.curve].name
    return (
        f"'{name}' ends loose at {place_text(one.place, text)}: {text(one.length)} of it was left out. "
        f"{_nearest(network, one.curve, one.place, text)}"
    )


def _nearest(network: Network, i: int, place: np.ndarray | None, text: Text) -> str:
    """The nearest curve to a loose place, or to those ends of a curve that meet no other one."""
    curve = network.curves[i]
    others = [(k, _samples(other)) for k, other in enumerate(network.curves) if k != i]
    if not others:
        return "There is no other curve."
    ends = points_at(curve.pieces, np.array([0.0, curve.end])) if place is None else [place]
    gaps = [
        min((float(np.linalg.norm(points - end, axis=1).min()), k) for k, points in others)
        for end in ends
    ]
    loose = [(gap, k) for gap, k in gaps if gap > network.tolerance]
    if not loose:
        return "Draw curves across it."
    gap, k = min(loose)
    return f"'{network.curves[k].name}' is {text(gap)} away from its end: extend it to there, or shorten it."


def _samples(curve: Curve) -> np.ndarray:
    return points_at(curve.pieces, np.linspace(0.0, curve.end, 8 * len(curve.pieces) + 1))


def none_text(network: Network, text: Text = plain) -> str:
    """Why there is no surface; begins with what to do."""
    said = remarks(network, text)
    start = "Draw curves across one another, whose ends lie on others: these enclose nothing. "
    if not network.crossings and len(network.curves) > 1:
        start += f"No two of them come nearer to each other than {text(network.tolerance)} (Snap). "
    return (start + " ".join(said[:_TOLD])).strip()
