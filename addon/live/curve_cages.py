# SPDX-License-Identifier: GPL-3.0-or-later
"""Live surfaces over curves: their control meshes are updated before the surfaces."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING

from .. import curve_cage, errors
from ..blender import Object
from ..errors import JobError
from . import registry
from .registry import session_key

if TYPE_CHECKING:
    from .session import Session


def refreshed(sessions: Iterable[Session], changed: Collection[int | str]) -> set[int | str]:
    """Keys of the control meshes updated because one of their curves is among `changed`."""
    found: dict[int | str, str] = {}  # control mesh: why it could not be updated
    for session in sessions:
        source = session.objects()[0]
        if source is None or not curve_cage.is_cage(source):
            continue
        key = session_key(source.data)
        if key not in found and not curve_cage.keys(curve_cage.watched(source)).isdisjoint(changed):
            found[key] = _followed(source)
        if found.get(key):
            session.wait(found[key])
    return {key for key, trouble in found.items() if not trouble}


def _followed(cage: Object) -> str:
    try:
        with registry.ignoring_updates(), errors.explained(cage.name):
            curve_cage.follow(cage)
    except JobError as error:
        return str(error)
    return ""
