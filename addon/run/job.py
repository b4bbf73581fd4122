# SPDX-License-Identifier: GPL-3.0-or-later
"""One object's way from its mesh to the new object, in three steps: read, compute, write.

Reading and writing belong to Blender's main thread. Computing touches nothing of Blender and may run on any thread.
"""

from contextlib import nullcontext

from .. import native
from ..carry.carrier import Carrier
from ..carry.lattice import fine_edges
from ..carry.symmetry import find_mirrors, symmetrize, uneven_axes
from ..check import messages
from ..inspection import convergence, display, override
from ..preferences import preferences
from ..read.data import read_data
from ..read.mesh import read_mesh
from ..read.region import NONE_SELECTED, selected_faces
from ..read.source import control_mesh
from ..request import size
from ..request.arguments import fair_arguments
from ..settings.properties import energy_name, snapshot
from ..write.data import write_data
from ..write.mesh import write_mesh
from ..write.modifiers import copy_modifiers
from ..write.object import new_object, remember, replace_mesh
from ..write.shape_keys import write_shape_keys
from .job_error import JobCancelled, JobError


class Job:
    """The fairing of one object. A failed or cancelled job leaves everything as it was."""

    def __init__(self, context, source, settings, target=None, region=None):
        """Reads all that will be needed; `settings` may change or go afterwards.

        `target`: an object that gets the surface as its mesh; None: a new one is made. `region`: (r,) ids of the faces to
        fair with `use_selection`; None: those that are selected now.
        """
        self.source = source
        self.target = target
        self.name = source.name
        self.settings = snapshot(settings)
        evaluated = self.settings.mesh_source == "EVALUATED" and not self.settings.use_selection
        with (
            override.suspended(context, source) if evaluated else nullcontext(),
            control_mesh(context, source, evaluated) as mesh,
        ):
            self.arrays = read_mesh(mesh)
            self.data = read_data(source, mesh, evaluated)
            if not self.settings.use_selection:
                region = None
            elif region is None:
                region = selected_faces(mesh)
        if region is not None and not len(region):
            raise JobError(f"{self.name}: {NONE_SELECTED}")
        self.triangles = size.triangle_count(self.arrays.face_sizes, self.settings.levels)
        too_large = size.why_too_large(self.triangles)
        if too_large:
            raise JobError(f"{self.name}: {too_large}.", code="TOO_LARGE")
        self.keys = self.data.shape_keys if self.settings.use_shape_keys else None
        self.arguments = fair_arguments(
            self.arrays, self.settings, preferences(), region, self.keys.shapes if self.keys else None
        )
        self.notes = list(self.data.notes)  # what the user may want to know, a sentence each
        if "shapes" in self.arguments and self.settings.energy != "THIN_PLATE":
            self.notes.append(
                "Each shape key is faired by itself. Values in between blend these surfaces, which only Thin Plate keeps fair."
            )
        self.result = None

    def compute(self, **watchers):
        """Runs the core; `watchers` are its `monitor` and `progress`."""
        core = native.core()
        try:
            self.result = core.fair(**self.arguments, **watchers)
        except core.FairingError as error:
            kind = JobCancelled if error.code == "CANCELLED" else JobError
            sentence = messages.error_text(self.name, error)
            raise kind(sentence, error.code, error.kind, error.elements) from error
        self.carrier = Carrier(self.result, self.arrays, self.settings.levels)
        if self.settings.keep_symmetry:
            self._symmetrize()

    def _symmetrize(self):
        result, arguments = self.result, self.arguments
        mirrors, notes = find_mirrors(
            self.carrier, self.arrays, result.crease_edges, arguments["corner_vertices"]
        )
        self.notes += notes
        self.notes += [
            f"The mesh is symmetric in {axis} but its surface is not, by more than rounding: no exact symmetry."
            for axis in uneven_axes(result.vertices, mirrors)
        ]
        result.vertices = symmetrize(result.vertices, mirrors, self.arrays.positions)
        result.shapes = [
            symmetrize(shape, mirrors, positions)
            for shape, positions in zip(result.shapes, arguments.get("shapes", ()))
        ]

    def is_writable(self):
        """Whether all objects that writing needs still exist: a long run leaves time to delete them."""
        try:
            return all(o.name and o.data for o in (self.source, self.target) if o is not None)
        except ReferenceError:
            return False

    def write(self, context):
        """Makes the object, or gives `target` its new mesh, and returns it."""
        result, settings = self.result, self.settings
        sharp_pairs = fine_edges(result.faces, result.crease_edges, settings.levels)
        mesh = write_mesh(f"{self.name} Fair", result, sharp_pairs, self.source.data.materials)
        if self.target is None:
            target = new_object(context, self.source, mesh)
        else:
            target = replace_mesh(self.target, mesh)
        write_data(target, self.data, self.carrier, ("sharp_face",) if settings.shade_smooth else ())
        if self.keys:
            write_shape_keys(target, self.keys, result.shapes, self.source)
        if settings.copy_modifiers and settings.mesh_source == "ORIGINAL" and self.target is None:
            self.notes += copy_modifiers(context, self.source, target)
            override.take_off(target)  # how the source is looked at is none of its modifiers
        remember(target, self.source, settings, result.report)
        display.refresh(target, context.scene.discrete_fairing_inspection)
        return target

    def warnings(self):
        """What the user should know of a finished job, a sentence each."""
        report = self.result.report
        sentences = [messages.warning_text(self.name, warning) for warning in report["warnings"]]
        told = any(warning["code"] == "NOT_CONVERGED" for warning in report["warnings"])
        if not told and not convergence.has_converged(report):
            sentences.append(messages.unfinished_text(self.name, energy_name(self.settings.energy)))
        return sentences
