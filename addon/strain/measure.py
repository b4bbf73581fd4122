# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the strain of a source: read on Blender's main thread, computed on any."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from .. import core, errors, size
from ..blender import Context, Mesh, Object, scene_of
from ..live.switch import live_surfaces_of, surfaces_of
from ..mesh.offset_names import read_names
from ..mesh.read import shown_selection
from ..mesh.shape_keys import mixed_positions
from ..mesh.timed_run import TimedRun
from ..preferences import preferences
from ..settings import Settings, halves
from .strained import Strained, knuckle

_LEVELS = 2  # on which the core computes


def settings_for(context: Context, source: Object) -> Settings:
    """Settings of the live surface of `source`, else of its last one, else of the next."""
    made = live_surfaces_of(source) or surfaces_of(source)[-1:]
    return Settings.of(made[-1].discrete_fairing if made else scene_of(source).discrete_fairing)


def plate_settings(settings: Settings) -> Settings:
    """The same for the whole original mesh, and for a surface through all vertices."""
    return replace(settings, use_selection=False, interpolation="EXACT", use_shape_keys=False)


class PlateRun(TimedRun):
    """The thin plate through all control vertices of one source, from which strain is measured."""

    def _read_plate(
        self, context: Context, source: Object, positions: Callable[[Mesh], np.ndarray]
    ) -> None:
        """`positions(mesh)`: those of the vertices."""
        settings = plate_settings(settings_for(context, source))
        with self._reading(context, source) as mesh:
            self.names, self.positions = read_names(mesh), positions(mesh)
            self.selected = shown_selection(mesh.vertices)
        self._world = self.shape.of_arrays(replace(self.arrays, positions=self.positions))
        self.arguments = core.fair_arguments(self._world, settings, preferences())
        coarse = size.coarse_triangles(self.arrays.face_sizes) * halves(settings)
        self.triangles = coarse * 4**_LEVELS


class StrainJob(PlateRun):
    """The strain of one source, with its present edits."""

    kind = "STRAIN"
    result: Strained | None

    def __init__(
        self,
        context: Context,
        source: Object,
        known: "StrainJob | None" = None,
        as_mixed: bool = True,
    ) -> None:
        """Reads the mesh; raises JobError if that is impossible. `known`: an earlier job, whose result
        is used if nothing has changed since. `as_mixed`: with the mix of shape keys, not the mesh
        alone.
        """

        def positions(mesh: Mesh) -> np.ndarray:
            own = self.arrays.positions
            return mixed_positions(source, mesh, own) if as_mixed else own

        self._read_plate(context, source, positions)
        self.arguments = core.plate_arguments(self.arguments)
        self.result = None
        if known is not None and known.result is not None and self.is_that_of(known):
            self.result = known.result

    def is_that_of(self, other: "StrainJob") -> bool:
        """Whether both jobs have the same input."""
        return self.shape == other.shape and core.are_equal(self.arguments, other.arguments)

    @property
    def predicted_seconds(self) -> float:
        return super().predicted_seconds if self.result is None else 0.0

    def compute(self, **watchers: Any) -> None:
        """Measures, unless there is a result already."""
        if self.result is None:
            super().compute(**watchers)

    def _compute(self, watchers: dict[str, Any]) -> None:
        with errors.explained(self.name):
            found = core.module().strain(**self.arguments, **watchers)
        back = self.shape.way_back[:3, :3]
        self.result = Strained(
            self.positions,
            found.excess_ways @ back,
            found.excess,
            found.floor,
            self._world.mean_edge_length,
            found.wrong,
            self.names,
            knuckle_of(found.excess, self.arrays, self.positions),
        )

    def note(self) -> None:
        if self.taken:
            super().note()


def knuckle_of(lengths: np.ndarray, arrays: core.ControlArrays, positions: np.ndarray) -> list[int]:
    """Ids along a chain of strained vertices that suggests a missing crease; `lengths` (n,)."""
    crease = arrays.edge_crease
    creased = np.zeros(len(arrays.edges), bool) if crease is None else crease > 0.0
    return knuckle(lengths, arrays.edges, creased, arrays.edge_uses == 1, positions)
