# SPDX-License-Identifier: GPL-3.0-or-later
"""The solver of one live surface, at a level and by an energy that keep up with edits; and what the surface depends on
beside its source, scans and a neighbour.
"""

from __future__ import annotations

from collections.abc import Collection
from contextlib import AbstractContextManager
from typing import Any, TypeAlias

import bpy
import numpy as np

from .. import core, size
from ..blender import Mesh, Object, current_context
from ..core import ControlArrays
from ..jobs.fit import live_scan
from ..mesh import scans
from ..mesh.object import session_key
from ..mesh.read import control_mesh, group_values, read_mesh, selected_faces
from ..mesh.world_shape import world_matrix, world_shape
from ..preferences import preferences
from ..settings import Settings, halves, is_evaluated
from ..surfaces import neighbours
from .full_level import is_dragging
from .pace import Deadline, Pace


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


# accurate enough for display, and usually one step an update; the full level has the core's default
# accuracy
_RESIDUAL = 1e-3
_STEP = 1e-2

# the dependency graph of the current update; None outside an update
Update: TypeAlias = bpy.types.Depsgraph | None


class LiveSolver:
    """Everything that is made for the settings of one surface; others get another one."""

    def __init__(self, source: Object, target: Object) -> None:
        self.settings = Settings.of(target.discrete_fairing)
        self.dependencies = Dependencies()
        self.pace = Pace()
        self.level = 0
        self.solver: Any = None
        self.arguments: Any = None  # of the solver
        self.mesh: int | None = None  # key of the mesh that has the solver's faces
        self.arrays: Any = None  # the control mesh of the last surface
        self.region: np.ndarray | None = None
        # of the mesh that the solver was made for, which a drag does not change
        self.edge_length = 0.0
        self._chosen = _chosen_level(target)
        self._shape = world_shape(source)
        self._values: dict[str, np.ndarray] = {}  # from vertex groups

    def fits(self, source: Object, target: Object) -> bool:
        """Whether the settings are the same; the scale of the source counts as one."""
        return (
            self.settings == Settings.of(target.discrete_fairing)
            and self._chosen == _chosen_level(target)
            and self._shape == world_shape(source)
            and self.dependencies.are_of(target)
        )

    def mesh_now(self, source: Object, depsgraph: Update) -> AbstractContextManager[Mesh]:
        """The present control mesh, from Object Mode, Sculpt Mode or during an edit; read only."""
        return control_mesh(current_context(), source, is_evaluated(self.settings), depsgraph)

    def read(self, source: Object, depsgraph: Update) -> ControlArrays:
        """The present control mesh, and the values of its groups, unless they are unchanged: a drag changes none,
        and reading is slow.
        """
        with self.mesh_now(source, depsgraph) as mesh:
            arrays = read_mesh(mesh)
            if not (
                self.arrays is not None
                and not is_evaluated(self.settings)
                and is_dragging(current_context())
                and arrays.has_faces_of(self.arrays)
            ):
                self._values = group_values(source, mesh, self.settings)
        return arrays

    def solve(self, source: Object, arrays: ControlArrays, depsgraph: Update) -> Any:
        """The surface at a level and by an energy that are fast enough; finds these by trial if needed."""
        while True:
            deadline = Deadline()
            try:
                world = self._shape.of(arrays.positions)
                result = self.solver.solve(world, progress=deadline)
                result.vertices = self._shape.back(result.vertices, world, arrays.positions)
                return result
            except core.module().FairingError:
                if not deadline.is_over:
                    raise
                if not self.pace.slow_down(self.level, self.arguments["energy"], hopeless=True):
                    raise
            self.prepare(source, arrays, depsgraph)

    def prepare(self, source: Object, arrays: ControlArrays, depsgraph: Update) -> bool:
        """Makes a solver unless the present one fits; returns whether it did."""
        if self.settings.use_selection and (
            self.region is None or not arrays.has_faces_of(self.arrays)
        ):
            with self.mesh_now(source, depsgraph) as mesh:
                self.region = selected_faces(mesh, source.name)
        computed = size.coarse_triangles(arrays.face_sizes) * halves(self.settings)
        self.pace.least = 2 if "neighbour" in self.dependencies.arguments else 1
        self.level = self.pace.level(self._chosen, computed)
        world = self._shape.of_arrays(arrays)
        if not (self.edge_length and arrays.has_faces_of(self.arrays)):
            self.edge_length = world.mean_edge_length
        arguments = core.fair_arguments(
            world,
            self.settings,
            preferences(),
            self.region,
            edge_length=self.edge_length,
            **self._values,
        )
        arguments |= {
            "levels": self.level,
            "relative_residual": _RESIDUAL,
            "step_tolerance": _STEP,
        }
        arguments["energy"] = self.pace.energy(arguments["energy"])
        arguments |= self.dependencies.arguments
        if (
            self.solver is not None
            and core.are_equal(_without_vertices(arguments), _without_vertices(self.arguments))
            and _are_together(arrays.positions, self.solver.vertex_origin)
        ):
            return False
        self.solver = self.mesh = None
        self.solver = core.solver(arguments)
        self.arguments = arguments
        return True

    @property
    def slower(self) -> list[str]:
        """Settings that are reduced during edits, a line each."""
        less = ["Bending while editing"] if self.pace.is_plain else []
        if self.level < self._chosen:
            less.append(f"Level {self.level} instead of {self._chosen}, to keep up")
        return less


def _chosen_level(target: Object) -> int:
    return min(target.discrete_fairing_live.levels, target.discrete_fairing.levels)


def _without_vertices(arguments: dict[str, Any]) -> dict[str, Any]:
    """The arguments without vertices; one solver serves while they are equal."""
    return {name: value for name, value in arguments.items() if name != "vertices"}


def _are_together(positions: np.ndarray, origin: np.ndarray | None) -> bool:
    """Whether vertices (n, 3) that a solver has merged into their `origin` (n,) coincide."""
    if origin is None:
        return True
    rows = np.flatnonzero(origin != np.arange(len(origin)))
    here, there = positions[rows], positions[origin[rows]]
    return bool(((here == there) | ~np.isfinite(here)).all())
