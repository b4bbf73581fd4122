# SPDX-License-Identifier: GPL-3.0-or-later
"""Strain: show it, select strained vertices, go to one, write a table; and easing, which moves vertices that spoil the
surface.
"""

from collections.abc import Iterable, Sequence
from typing import Any, cast

import bpy
import numpy as np
from bpy.props import StringProperty
from mathutils import Vector

from ..blender import Context, Object
from ..check.defects import select_defects, select_in_all
from ..choices import EASE_AMOUNTS, STRAINED
from ..errors import JobError
from ..fields import choice, length, number, switch, whole
from ..memory import active_source
from ..mesh.edited import edited
from ..mesh.object import why_not_here
from ..mesh.read import control_meshes, source_objects
from ..mesh.shape_keys import EASED, key_positions
from ..mesh.world_shape import transformed, world_matrix
from ..poll import Reason, in_edit_mode, in_mode, of_meshes
from ..settings import values_of
from ..strain import cache, words
from ..strain.ease import EaseJob, EaseOptions, EaseSelectedJob
from ..strain.measure import StrainJob
from ..strain.strained import Strained
from ..ui.active import fairing_operator
from ..units import Units
from .fair import InMeshes, WholeFairing, can_fair
from .mixins import Action, Shown
from .modal import invoke_soon
from .presets import whole_of
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
        written = words.table_text(
            in_world(job.result.positions),
            job.result.lengths,
            None if eased is None else in_world(eased),
            job.names,
        )
        write_text_file(self.filepath, written)
        path = bpy.path.abspath(self.filepath)
        self.report({"INFO"}, f"{words.count(len(job.result.positions))} written to {path}")


class _Easing(InMeshes):
    """The common part: writes the result if it still applies, and reports it."""

    cancelled_text = "Easing was cancelled: nothing has changed"

    def write(self, context: Context, jobs: Sequence[Any]) -> None:
        self.put(context, list(jobs))
        for job in jobs:
            job.note()
            said = job.said(Units.of(context.scene).lengths(job.longest))
            self.report({"INFO"}, f"{job.name}: {said}")

    def put(self, context: Context, jobs: list[Any]) -> None:
        raise NotImplementedError


class OBJECT_OT_fairing_ease(Shown, _Easing, bpy.types.Operator):
    """Move vertices a little, as the shape key Eased: removes scatter and corrects wrong offsets"""

    bl_idname = "object.fairing_ease"
    bl_label = "Ease Control Mesh"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    amount: choice("Amount", "How far vertices are moved", EASE_AMOUNTS)
    tolerance: length(
        "Tolerance",
        "How far a vertex may be moved, in scene units",
        0.005,
        soft_max=1.0,
        precision=4,
    )
    stiffness: number(
        "Stiffness",
        "At 1 it removes half of the scatter between neighbouring vertices; larger values remove more",
        1.0,
        min=0.0,
        soft_max=10.0,
    )
    count: whole("Number", "How many vertices move at most", 3, min=1, soft_max=30)
    use_selection: switch(
        "Selected Vertices Only", "Vertices that are not selected in Edit Mode stay where they are"
    )
    go_on: switch(
        "Go On from Eased",
        "Starts from the shape key Eased, if there is one: first the worst vertices, then the scatter of all",
    )
    fair_afterwards: switch(
        "Fair Afterwards",
        "Makes the surface, or makes it again, once the vertices are eased",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    reasons = (
        can_fair,
        in_mode(
            "Press Tab first, or use Ease Selected: the whole control mesh is eased in Object Mode",
            "OBJECT",
        ),
        of_meshes(active_sources),
    )

    def shown(self, _context: Context) -> Iterable[str]:
        own = {"TOLERANCE": ["tolerance"], "STIFFNESS": ["stiffness"], "WORST": ["count"]}
        return ("amount", *own.get(self.amount, ()), "use_selection", "go_on")

    def make_jobs(self, context: Context) -> list[Any]:
        options = values_of(EaseOptions, self)
        return [EaseJob(context, source, options) for source in active_sources(context)]

    def put(self, context: Context, jobs: list[Any]) -> None:
        for job in jobs:
            job.write_key()
        if self.fair_afterwards:
            whole = whole_of(context, "POINTS", control_meshes(context))
            invoke_soon(context, fairing_operator(context), whole)


class OBJECT_OT_fairing_ease_selected(_Easing, bpy.types.Operator):
    """Move selected vertices, except on borders and creases, to the surface through all others"""

    bl_idname = "object.fairing_ease_selected"
    bl_label = "Ease Selected"

    factor: number(
        "Factor",
        "How far the vertices move: at 1 to the surface through the others",
        1.0,
        soft_min=0.0,
        soft_max=1.0,
        subtype="FACTOR",
    )

    reasons = (can_fair, *in_edit_mode("vertices"))

    def make_jobs(self, context: Context) -> list[Any]:
        return [EaseSelectedJob(context, source, self.factor) for source in source_objects(context)]

    def put(self, _context: Context, jobs: list[Any]) -> None:
        for job in jobs:
            job.write()
