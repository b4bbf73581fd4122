# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a run will take: by what this machine's last runs took, of the same mesh if there were any.

The last few of each energy are kept in the preferences, not in files.
"""

import json
from collections.abc import Hashable

from .preferences import preferences

PATIENCE = 0.5  # seconds; a run that is predicted to take longer never stops the window
_KEPT = 5  # runs of an energy
_BRIEF = (
    0.1  # seconds; a shorter run is hardly spent on triangles, and tells the most that one takes
)
_TRIED = (
    1e5  # triangles; so few are tried at first, since what takes longer than PATIENCE is broken off
)
# seconds a triangle on a machine of two cores, until it has runs of its own
_AT_FIRST = {
    "THIN_PLATE": 2e-5,
    "TOTAL_CURVATURE": 6e-4,
    "MINIMUM_VARIATION": 1e-3,
    "STRAIN": 6e-5,  # some eight thin plates
    "EASE": 1.2e-4,
    "CLEAN": 4e-5,
    "FIT": 4e-5,  # and a point of the scan
}

_of_mesh: dict[tuple[Hashable, str], float] = {}  # (mesh, energy): seconds a triangle


def seconds(energy: str, triangles: int, mesh: Hashable = None) -> float:
    """What a run will take; `mesh`: what `note` was told of an earlier run, None for any mesh."""
    known = _of_mesh.get((mesh, energy))
    if known is None:  # rather too long than too short: meshes differ by a factor of ten
        known = max(_speeds().get(energy) or [_AT_FIRST[energy]])
    return triangles * known


def hoped_seconds(energy: str, triangles: int, mesh: Hashable) -> float:
    """As `seconds`, but rather too short on a machine that has no runs of its own yet."""
    expected = seconds(energy, triangles, mesh)
    return expected if _speeds().get(energy) else min(expected, PATIENCE * triangles / _TRIED)


def note(energy: str, triangles: int, taken: float, mesh: Hashable) -> None:
    """Learns that a run has taken so many seconds."""
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
    """As on a machine that has done nothing yet."""
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
    try:
        found = json.loads(preferences().speeds)
    except ValueError:
        return {}
    if not isinstance(found, dict):
        return {}
    return {
        energy: [float(speed) for speed in found[energy]]
        for energy in _AT_FIRST
        if isinstance(found.get(energy), list)
    }
