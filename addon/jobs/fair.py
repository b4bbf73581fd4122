# SPDX-License-Identifier: GPL-3.0-or-later
"""One object's way from its mesh to the new object, in three steps: read, compute, write.

Reading and writing belong to Blender's main thread. Computing uses nothing of Blender and may run on
any thread.
"""

from collections.abc import Iterator, Mapping
from contextlib import nullcontext
from typing import Any

import numpy as np

from .. import core, errors, memory, prediction, size
from ..blender import Context, Mesh, Object, scene_of
from ..check import cages
from ..check.faults import find_faults
from ..check.turns import prisms_text
from ..choices import ENERGY_NAMES
from ..errors import JobError
from ..inspection import display
from ..mesh.layers import read_data
from ..mesh.modifiers import copy_modifiers, left_out, without_inspection
from ..mesh.object import Reference, new_surface
from ..mesh.own import OwnData, carried_names, read_own, write_own
from ..mesh.read import group_values, selected_faces, shown_selection
from ..mesh.shape_keys import write_shape_keys
from ..mesh.timed_run import TimedRun
from ..mesh.write import write_surface
from ..preferences import preferences
from ..settings import Settings, halves, is_evaluated, subdivision, wants_modifiers
from ..surfaces import freshness, neighbours, place
from ..transfer.attributes import AttributeTransfer
from ..transfer.seams import edge_table, sharp_pairs

NOTICED_MEMORY = 2**28  # bytes: less is negligible beside Blender itself


class Job(TimedRun):
    """The fairing of one object. A failed or cancelled job changes nothing."""

    made_name = "Fair"  # of a new object, after its source's name
    remedies = errors.REMEDIES

    def __init__(
        self,
        context: Context,
        source: Object,
        settings: Settings,
        target: Object | None = None,
        region: np.ndarray | None = None,
        neighbour: Object | None = None,
        surface: Object | None = None,
        halfway: bool | None = None,
    ) -> None:
        """Reads all data that the run needs.

        `target`: the object whose mesh the surface becomes; None: a new object. `region`: (r,) ids of
        the faces to fair with `use_selection`; None: the current selection. `neighbour`: the object
        that the border meets, None: that of the target, if any; it is placed relative to `surface`,
        None: the target. `halfway`: whether both change; None: as the neighbours are now.
        """
        self._target = None if target is None else Reference(target)
        evaluated = is_evaluated(settings)
        with (
            without_inspection(context, source) if evaluated else nullcontext(),
            self._reading(context, source, evaluated) as mesh,
        ):
            self.data = read_data(source, mesh, evaluated)
            world = self.shape.of_arrays(self.arrays)
            by_shape = cages.choice(settings, world)
            self.settings = settings.for_source(source, by_shape)
            values = group_values(source, mesh, self.settings)
            selection = shown_selection(mesh.polygons) if self.settings.use_selection else None
            if selection is None:
                region = None
            elif region is None:
                region = selected_faces(mesh, self.name)
        self.keys = self.data.shape_keys if self.settings.use_shape_keys else None
        own = freshness.OwnMesh(self.arrays, selection, values, self.keys)
        self.kind = self.settings.energy
        self._made = freshness.made_of(context, source, self.settings, None if evaluated else own)
        self.edge_length = world.mean_edge_length
        self.triangles = size.triangle_count(self.arrays.face_sizes, self.settings.levels)
        too_large = size.why_too_large(self.triangles)
        if too_large:
            raise JobError(f"{self.name}: {too_large}.", code="TOO_LARGE")
        self.arguments = core.fair_arguments(
            world,
            self.settings,
            preferences(),
            region,
            self.shape.of(self.keys.shapes) if self.keys else None,
            edge_length=self.edge_length,
            **values,
        )
        self._halfway = neighbours.is_mutual(target) if halfway is None else halfway
        stands = surface or place.next_of(source, target)
        self._meet(context, source, neighbour or neighbours.neighbour_of(target), stands)
        # remarks for the user, a sentence each
        self.notes = [*self.data.notes, *self._not_done()]
        if target is None and not (evaluated or settings.copy_modifiers):
            self.notes += left_out(source)
        if said := prisms_text(world, self.settings):
            self.notes.append(said)
        if by_shape != "EXACT" and subdivision(source) is None:
            self.notes.append(
                f"{cages.NOTES[by_shape]} To bend everywhere, set Vertices to Through."
            )

    @property
    def fewest_levels(self) -> int:
        """The fewest levels that the core takes: a border meets a neighbour from level 2 on."""
        return 1 if self._neighbour is None else 2

    def with_settings(self, context: Context, settings: Settings) -> "Job":
        """A job like this one with other settings."""
        assert self.source is not None
        met = None if self._neighbour is None else self._neighbour.find()
        return Job(
            context, self.source, settings, self.target, neighbour=met, halfway=self._halfway
        )

    def _meet(
        self, context: Context, source: Object, neighbour: Object | None, surface: Object
    ) -> None:
        """Sets the neighbour that the border meets, if there is one, relative to `surface`."""
        self._neighbour = None if neighbour is None else Reference(neighbour)
        self._made["neighbour"] = "" if neighbour is None else neighbour.name
        if neighbour is not None:
            self._made["beside"] = freshness.beside_of(context, neighbour, surface, self._halfway)
            self.arguments |= neighbours.arguments(
                context, neighbour, surface, source, self.settings, self._halfway
            )

    def _not_done(self) -> Iterator[str]:
        """Settings that the energy ignores, a sentence each."""
        if "shapes" in self.arguments and self.settings.energy != "THIN_PLATE":
            yield "Each shape key is faired separately. Mixtures of them are fair with Bending only."
        if self.arrays.normals is not None and not core.keeps_marks(self.settings):
            yield "Fixed normals are not used: only Bending supports them."
        marked = self.arrays.has_flats
        if marked and not core.keeps_marks(self.settings):
            yield "Flat faces are not kept: only Bending keeps them. Choose Bending."
        elif marked and not core.keeps_flats(self.settings):
            yield "Flat faces are not kept: Limit passes beside them. Set Vertices to Through."

    def _compute(self, watchers: dict[str, Any]) -> None:
        with errors.explained(self.name, self.remedies):
            self.result = self.surface(**watchers)
        self.transfer = AttributeTransfer(self.result, self.arrays, self.settings.levels)
        self._edges = edge_table(self.result.faces)
        self._at_tolerance = core.at_tolerance(self.arguments, self.result.vertices)
        self.faults = find_faults(self.result, self.transfer, self.control())
        self._to_object()
        mended = errors.repairs_text(self.result.report["repairs"])
        if mended:
            self.notes.append(mended)
        given_way = errors.pads_text(self.result.report["pads"])
        if given_way:
            self.notes.append(given_way)
        its = self.result, self.arrays, self.settings, self.settings.levels
        self._sharp_pairs = sharp_pairs(*its, self._edges)

    def surface(self, **watchers: Any) -> Any:
        return core.faired(self.arguments, **watchers)

    def control(self) -> core.ControlArrays:
        """The mesh with which the surface is compared, as arrays."""
        return self.shape.of_arrays(self.arrays)

    @property
    def _key(self) -> Any:
        return self.reference.key

    @property
    def predicted_seconds(self) -> float:
        """Rather too short on a new machine, so that the run is tried."""
        return prediction.hoped_seconds(self.kind, self._work(), self._key)

    def predict(self, energy: str, levels: int) -> float:
        """The predicted time with another energy and number of levels."""
        return prediction.seconds(energy, self._work(levels), self._key)

    def _work(self, levels: int | None = None) -> int:
        """Triangles of the surface and of each shape, with mirror images."""
        shapes = len(self.arguments.get("shapes", ()))
        levels = self.settings.levels if levels is None else levels
        one = size.triangle_count(self.arrays.face_sizes, levels)
        return one * (1 + shapes) * halves(self.settings)

    def _to_object(self) -> None:
        result, sent = self.result, self.arguments
        result.vertices = self.shape.back(result.vertices, sent["vertices"], self.arrays.positions)
        result.shapes = [
            self.shape.back(shape, world, own)
            for shape, world, own in zip(
                result.shapes, sent.get("shapes", ()), self.keys.shapes if self.keys else ()
            )
        ]

    @property
    def source(self) -> Object | None:
        """Found anew at each call, since it may have been deleted or replaced by undo; None if so."""
        return self.reference.find()

    @property
    def target(self) -> Object | None:
        """The object that gets the surface; None: a new one, or it was deleted."""
        return None if self._target is None else self._target.find()

    def is_writable(self) -> bool:
        """Whether all objects needed for writing still exist."""
        return all(r.find() is not None for r in (self.reference, self._target) if r is not None)

    def write(self, context: Context, own: OwnData | None = None) -> Object:
        """Makes the object, or gives `target` its new mesh; `own`: its data to keep, if read."""
        result, settings, source = self.result, self.settings, self.source
        old = self.target
        assert source is not None  # is_writable has checked it
        carried = carried_names(self.data, self.keys)
        if old is None:
            target = new_surface(context, source, f"{self.name} {self.made_name}")
        else:
            target = old
            own = own or read_own(target, carried, memory.recall(target, "carried") or {})
        its = result, self._sharp_pairs, self.data, self.transfer, settings, self._edges
        write_surface(target, *its)
        if self.keys:
            write_shape_keys(target, self.keys, result.shapes, source)
        if own is not None:
            self.notes += write_own(target, own)
        memory.keep(target, "carried", carried)
        if wants_modifiers(settings) and old is None:
            self.notes += copy_modifiers(context, source, target)
        self.mark(target.data)
        report = {**result.report, "faults": self.faults.counts, "at_tolerance": self._at_tolerance}
        memory.remember(target, source, settings, report)
        if self._neighbour is not None:
            target.discrete_fairing.neighbour = self._neighbour.find()
        if old is None:
            place.note(source, target)
        else:
            place.follow(context, target)
        neighbours.update_normals(context, target)
        neighbours.update_normals_of_others(context, target)
        freshness.note(target, self._made)
        display.refresh(target, scene_of(target).discrete_fairing_inspection)
        self.note()
        return target

    def mark(self, mesh: Mesh) -> None:
        """Adds attributes to `mesh` that mark the surface's faults."""
        self.faults.write(mesh)

    def warnings(self) -> list[str]:
        sentences = run_warnings(self.name, self.result.report, self.settings.energy)
        if self.faults.counts:
            sentences.append(
                errors.faults_text(self.name, self.faults.counts, self.settings, self.kind == "FIT")
            )
        return sentences


def run_warnings(name: str, report: Mapping[str, Any], energy: str) -> list[str]:
    """The core's warnings, one sentence each."""
    sentences = [
        errors.warning_text(name, warning)
        for warning in report["warnings"]
        if warning["code"] != "MEMORY_EXCEEDED" or report["peak_bytes"] >= NOTICED_MEMORY
    ]
    explained = any(map(errors.is_unfinished, report["warnings"]))
    if not explained and not core.has_converged(report):
        sentences.append(errors.unfinished_text(name, ENERGY_NAMES[energy]))
    return sentences
