# SPDX-License-Identifier: GPL-3.0-or-later
"""Ease Control Mesh and Ease Selected: move vertices that spoil the surface."""

from collections.abc import Iterable, Sequence
from typing import Any

import bpy

from ..blender import Context
from ..choices import EASE_AMOUNTS
from ..fields import choice, length, number, switch, whole
from ..mesh.read import source_objects
from ..poll import in_edit_mode, in_mode, of_meshes
from ..settings import values_of
from ..strain.ease import EaseJob, EaseOptions, EaseSelectedJob
from ..ui.active import fairing_operator
from ..units import Units
from . import redo
from .fair import InMeshes, can_fair
from .mixins import Shown
from .strain import active_sources


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
            redo.invoke_soon(context, fairing_operator(context), {})


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
