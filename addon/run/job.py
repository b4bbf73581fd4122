# SPDX-License-Identifier: GPL-3.0-or-later
"""One object's way from its mesh to the new object, in three steps: read, compute, write.

Reading and writing belong to Blender's main thread. Computing touches nothing of Blender and may run on any thread.
"""

from .. import native
from ..carry.lattice import fine_edges
from ..check import messages
from ..preferences import preferences
from ..read.mesh import read_mesh
from ..read.region import selected_faces
from ..read.source import control_mesh
from ..request import size
from ..request.arguments import fair_arguments
from ..settings.properties import snapshot
from ..write.mesh import write_mesh
from ..write.object import new_object, remember, replace_mesh
from .job_error import JobCancelled, JobError


class Job:
    """The fairing of one object. A failed or cancelled job leaves everything as it was."""

    def __init__(self, context, source, settings, target=None):
        """Reads all that will be needed; `settings` may change or go afterwards.

        `target`: an object that gets the surface as its mesh; None: a new one is made.
        """
        self.source = source
        self.target = target
        self.name = source.name
        self.settings = snapshot(settings)
        evaluated = self.settings.mesh_source == "EVALUATED" and not self.settings.use_selection
        with control_mesh(context, source, evaluated) as mesh:
            self.arrays = read_mesh(mesh)
            region = selected_faces(mesh) if self.settings.use_selection else None
        if region is not None and not len(region):
            raise JobError(
                f"{self.name}: no face is selected. Select the faces to fair in Edit Mode, "
                "or switch off Selected Faces Only."
            )
        self.triangles = size.triangle_count(self.arrays.face_sizes, self.settings.levels)
        too_large = size.why_too_large(self.triangles)
        if too_large:
            raise JobError(f"{self.name}: {too_large}.", code="TOO_LARGE")
        self.arguments = fair_arguments(self.arrays, self.settings, preferences(), region)
        self.result = None

    def compute(self, **watchers):
        """Runs the core; `watchers` are its `monitor` and `progress`."""
        core = native.core()
        try:
            self.result = core.fair(**self.arguments, **watchers)
        except core.FairingError as error:
            kind = JobCancelled if error.code == "CANCELLED" else JobError
            raise kind(
                messages.error_text(self.name, error),
                error.code,
                getattr(error, "kind", "mesh"),
                error.elements,
            ) from error

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
        mesh = write_mesh(
            f"{self.name} Fair",
            result,
            self.arrays,
            sharp_pairs,
            self.source.data.materials,
            settings.shade_smooth,
        )
        if self.target is None:
            target = new_object(context, self.source, mesh)
        else:
            target = replace_mesh(self.target, mesh)
        remember(target, self.source, settings, result.report)
        return target

    def warnings(self):
        """What the user should know of a finished job, a sentence each."""
        return [messages.warning_text(self.name, warning) for warning in self.result.report["warnings"]]
