# SPDX-License-Identifier: GPL-3.0-or-later
"""The dependencies of a live surface beside its source: scans and a neighbour."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from .. import core
from ..blender import Object, current_context
from ..jobs.fit import live_scan
from ..mesh import scans
from ..mesh.object import session_key
from ..mesh.world_shape import world_matrix
from ..settings import Settings
from ..surfaces import neighbours
from .full_level import is_dragging


class Dependencies:
    """Scans and neighbour of one surface as they were read last; nothing until then."""

    def __init__(self) -> None:
        self.arguments: dict[str, Any] = {}  # for core.solver
        self.due = False  # whether they may have changed since
        self._neighbour: int | None = None  # its key
        self._blocks: set[int] = set()  # keys of the data-blocks that they were read from
        self._seen: Any = None  # the transforms of source and surface then

    def read(self, source: Object, target: Object, settings: Settings) -> None:
        """Reads them now; raises JobError."""
        context, arguments = current_context(), {}
        scan = live_scan(context, source, target)
        if scan is not None:
            arguments["scan"] = scan
        neighbour = neighbours.neighbour_of(target)
        if neighbour is not None:
            mutual = neighbours.is_mutual(target)
            arguments |= core.with_partner(
                neighbours.arguments(context, neighbour, target, source, settings, mutual)
            )
        self.arguments, self._neighbour = arguments, _key_of(neighbour)
        self._blocks = set(map(session_key, scans.watched(neighbours.with_scans(target))))
        self._seen, self.due = _places(source, target), False

    def are_of(self, target: Object) -> bool:
        """Whether the surface still meets the neighbour that was read."""
        return self._neighbour == _key_of(neighbours.neighbour_of(target))

    def are_awaited(self, source: Object, target: Object, moved: Collection[int]) -> bool:
        """Whether they are to be read again: once nothing is dragged, since they may be large."""
        self.due |= not self._blocks.isdisjoint(moved)
        self.due |= bool(self._blocks) and self._seen != _places(source, target)
        return self.due and not moved and not is_dragging(current_context())


def _places(source: Object, target: Object) -> Any:
    return world_matrix(source).copy(), world_matrix(target).copy()


def _key_of(neighbour: Object | None) -> int | None:
    return None if neighbour is None else session_key(neighbour)
