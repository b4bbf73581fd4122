# SPDX-License-Identifier: GPL-3.0-or-later
"""Predicts the time of a run from this machine's last ones, which the preferences keep."""

import json
from collections.abc import Hashable

from .preferences import preferences

PATIENCE = 0.5  # seconds; a run that is predicted to take longer never stops the window
_KEPT = 5  # runs of each energy
# seconds; shorter runs are dominated by other costs, and bound the time a triangle from above
_BRIEF = 0.1
# Triangles; small runs are tried at first, since a run that exceeds PATIENCE is stopped.
_TRIED = 1e5
# seconds a triangle on a machine of two cores, until runs are known
_AT_FIRST = {
    "THIN_PLATE": 2e-5,
    "TOTAL_CURVATURE": 6e-4,
    "MINIMUM_VARIATION": 1e-3,
    "STRAIN": 6e-5,  # about eight thin plates
    "EASE": 1.2e-4,
    "CLEAN": 4e-5,
    "FIT": 4e-5,  # a triangle and a point of the scan
}

_of_mesh: dict[tuple[Hashable, str], float] = {}  # (mesh, energy): seconds a triangle


def seconds(energy: str, triangles: int, mesh: Hashable = None) -> float:
    """The predicted time of a run; `mesh`: the key of an earlier one, None for any."""
    known = _of_mesh.get((mesh, energy))
    if known is None:  # rather too long than too short, since meshes differ by a factor of ten
        known = max(_speeds().get(energy) or [_AT_FIRST[energy]])
    return triangles * known


def hoped_seconds(energy: str, triangles: int, mesh: Hashable) -> float:
    """Like `seconds`, but rather too short on a machine without runs."""
    expected = seconds(energy, triangles, mesh)
    return expected if _speeds().get(energy) else min(expected, PATIENCE * triangles / _TRIED)


def note(energy: str, triangles: int, taken: float, mesh: Hashable) -> None:
    if not triangles:
        return
    speed = taken / triangles
    if taken < _BRIEF:
        speed = min(speed, seconds(energy, 1, mesh))
    _of_mesh[mesh, energy] = speed
    speeds = _speeds()
    speeds[energy] = [*speeds.get(energy, []), speed][-_KEPT:]
    preferences().speeds = json.dumps(speeds)


def forget() -> None:
    _of_mesh.clear()
    preferences().speeds = "{}"


def text(predicted: float) -> str:
    """`about 20 s`; empty if the run is short."""
    if predicted <= PATIENCE:
        return ""
    if predicted < 99.5:
        return f"about {max(predicted, 1.0):.0f} s"
    return f"about {predicted / 60.0:.0f} min"


def _speeds() -> dict[str, list[float]]:
    return json.loads(preferences().speeds)
