# SPDX-License-Identifier: GPL-3.0-or-later
"""Strain: show it, select strained vertices, go to one, write a table."""

from collections.abc import Iterable, Sequence
from typing import Any, cast

import bpy
import numpy as np
from bpy.props import StringProperty
from mathutils import Vector

from ..blender import Context, Object
from ..check.defects import select_defects, select_in_all
from ..choices import STRAINED
from ..errors import JobError
from ..fields import choice, whole
from ..memory import active_source
from ..mesh.edited import edited
from ..mesh.object import why_not_here
from ..mesh.shape_keys import EASED, key_positions
from ..mesh.world_shape import transformed, world_matrix
from ..poll import Reason, of_meshes
from ..strain import cache, table, words
from ..strain.measure import StrainJob
from ..strain.strained import Strained
from ..units import Units
from .fair import WholeFairing, can_fair
from .mixins import Action, Shown
from .written_files import ByFileBrowser, write_text_file


def active_sources(context: Context) -> list[Object]:
    """The source of the active object, or itself; in Edit Mode all edited meshes."""
    if context.mode == "EDIT_MESH":
        return list(context.objects_in_mode_unique_data)
    source = active_source(context)
    return [] if source is None else [source]


class _Straining(WholeFairing):
    """The common part: measures the strain first, if anything has changed since the last time."""

    cancelled_text = "Measuring was cancelled: nothing has changed"

    reasons: tuple[Reason, ...] = (can_fair, of_meshes(active_sources))

    def make_jobs(self, context: Context) -> list[Any]:
        return [cache.job_for(context, source) for source in active_sources(context)]

    def finish(self, context: Context, jobs: Sequence[Any]) -> None:
        for job in jobs:
            if job.reference.find() is None:
                raise JobError(f"Select once more: {job.name} was deleted during the run")
            cache.keep(job)
        self.use(context, list(jobs))

    def use(self, context: Context, jobs: list[StrainJob]) -> None:
        raise NotImplementedError


class OBJECT_OT_fairing_strain(Action, bpy.types.Operator):
    """Show how far the surface would move at each vertex if that vertex were released: wrong offsets stand out"""

    bl_idname = "object.fairing_strain"
    bl_label = "Inspect: Strain"

    reasons = _Straining.reasons

    def act(self, context: Context) -> None:
        sources = active_sources(context)
        show = not all(source.discrete_fairing_strain.show for source in sources)
        for source in sources:
            source.discrete_fairing_strain.show = show


_TO_SELECT = (*_Straining.reasons, lambda c: why_not_here(c, active_sources(c)))


class OBJECT_OT_fairing_select_strained(Shown, _Straining, bpy.types.Operator):
    """Select in Edit Mode the vertices with the largest strain"""

    bl_idname = "object.fairing_select_strained"
    bl_label = "Select Strained"

    reasons = _TO_SELECT

    by: choice("Which", "Which vertices are selected", STRAINED)
    count: whole("Number", "How many vertices", 3, min=1, soft_max=30)

    def shown(self, _context: Context) -> Iterable[str]:
        return ("by",) if self.by == "FLOOR" else ("by", "count")

    def use(self, context: Context, jobs: list[StrainJob]) -> None:
        wanted: list[Any] = []
        for job in jobs:
            strained = job.result
            assert strained is not None  # computing has set it
            text = Units.of(context.scene).lengths(max(strained.largest, strained.floor))
            chosen = self._chosen(strained)
            if len(chosen):
                said = words.found(chosen, strained.lengths, text, strained.names)
            else:
                said = words.none_above(strained.floor, strained.largest, text)
            self.report({"INFO"}, f"{job.name}: {said}")
            wanted.append((job.reference.find(), [("vertex", chosen.tolist())]))
        select_in_all(context, wanted)

    def _chosen(self, strained: Strained) -> np.ndarray:
        return strained.wrong if self.by == "FLOOR" else strained.worst(self.count)


class OBJECT_OT_fairing_crease_knuckle(_Straining, bpy.types.Operator):
    """Crease the edges along strained vertices that form a chain: a knuckle, not wrong offsets"""

    bl_idname = "object.fairing_crease_knuckle"
    bl_label = "Crease Knuckle"

    def use(self, context: Context, jobs: list[StrainJob]) -> None:
        done = 0
        for job in jobs:
            source, strained = job.reference.find(), job.result
            assert source is not None and strained is not None  # computing has set it
            if strained.knuckle:
                self.report(
                    {"INFO"}, f"{job.name}: {_crease(source, strained.knuckle)} edges creased"
                )
                done += 1
        if not done:
            raise JobError("Crease edges by hand (Shift E): no strained vertices form a chain")


def _crease(source: Object, chain: list[int]) -> int:
    """Creases the edges along the `chain` of vertices; returns their number."""
    with edited(source) as bm:
        layer = bm.edges.layers.float.get("crease_edge") or bm.edges.layers.float.new("crease_edge")
        bm.verts.ensure_lookup_table()
        sides = [bm.edges.get((bm.verts[v], bm.verts[w])) for v, w in zip(chain, chain[1:])]
        for side in sides:
            side[layer] = 1.0
    return len(sides)


class OBJECT_OT_fairing_go_to_strained(Action, bpy.types.Operator):
    """Select this vertex in Edit Mode and bring it to the middle of the viewport"""

    bl_idname = "object.fairing_go_to_strained"
    bl_label = "Go to Vertex"

    vertex: whole("Vertex", "Which vertex of the control mesh", min=0)

    reasons = _TO_SELECT

    def act(self, context: Context) -> None:
        source = cast(Object, active_source(context))
        if not select_defects(context, source, "vertex", [self.vertex]):
            raise JobError(f"Choose another vertex: {source.name} has no vertex {self.vertex}")
        space = cast(Any, context.space_data)
        strained = cache.found_of(source)
        if space is not None and space.type == "VIEW_3D" and strained is not None:
            place = Vector(strained.positions[self.vertex].tolist())
            space.region_3d.view_location = world_matrix(source) @ place


class OBJECT_OT_fairing_strain_table(ByFileBrowser, _Straining, bpy.types.Operator):
    """Write vertices, their strain and, if eased, new places and moves as a table (CSV), in scene units"""

    bl_idname = "object.fairing_strain_table"
    bl_label = "Table of Strain (CSV)"
    bl_options = {"REGISTER"}
    cancelled_text = "Measuring was cancelled: nothing was written"
    filename_ext = ".csv"

    filter_glob: StringProperty(default="*.csv", options={"HIDDEN"})

    def make_jobs(self, context: Context) -> list[Any]:
        """For the mesh itself, without its shape keys."""
        return [StrainJob(context, cast(Object, active_source(context)), as_mixed=False)]

    def finish(self, context: Context, jobs: Sequence[Any]) -> None:
        (job,) = jobs
        source = job.reference.find()
        if source is None:
            raise JobError(
                f"Write it once more: {job.name} was deleted during the run, and nothing was written"
            )
        matrix = np.array(world_matrix(source))

        def in_world(positions: np.ndarray) -> np.ndarray:
            return transformed(positions, matrix)

        eased = key_positions(source, EASED, len(job.result.positions))
        written = table.text(
            in_world(job.result.positions),
            job.result.lengths,
            None if eased is None else in_world(eased),
            job.names,
        )
        write_text_file(self.filepath, written)
        path = bpy.path.abspath(self.filepath)
        self.report({"INFO"}, f"{words.count(len(job.result.positions))} written to {path}")
