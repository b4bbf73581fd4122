# SPDX-License-Identifier: GPL-3.0-or-later
"""One object's way from its mesh to the new object, in three steps: read, compute, write.

Reading and writing belong to Blender's main thread. Computing touches nothing of Blender and may run on any thread.
"""

from .. import native
from ..carry.lattice import fine_edges
from ..check import messages
from ..read.mesh import read_mesh
from ..read.source import control_mesh
from ..request import size
from ..request.arguments import fair_arguments
from ..settings.properties import snapshot
from ..write.mesh import write_mesh
from ..write.object import write_object


class JobError(Exception):
    """Why an object cannot be faired, as a sentence for its user."""


class Job:
    """The fairing of one object. A failed or cancelled job leaves everything as it was."""

    def __init__(self, context, source, settings):
        """Reads all that will be needed; `settings` may change or go afterwards."""
        self.source = source
        self.name = source.name
        self.settings = snapshot(settings)
        with control_mesh(context, source) as mesh:
            self.arrays = read_mesh(mesh)
        self.triangles = size.triangle_count(self.arrays.face_sizes, self.settings.levels)
        too_large = size.why_too_large(self.triangles)
        if too_large:
            raise JobError(f"{self.name}: {too_large}.")
        self.arguments = fair_arguments(self.arrays, self.settings)
        self.result = None

    def compute(self, **watchers):
        """Runs the core; `watchers` are its `monitor` and `progress`."""
        core = native.core()
        try:
            self.result = core.fair(**self.arguments, **watchers)
        except core.FairingError as error:
            raise JobError(messages.error_text(self.name, error)) from error

    def write(self, context):
        """Makes the new object and returns it."""
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
        return write_object(context, self.source, mesh, result.report)

    def warnings(self):
        """What the user should know of a finished job, a sentence each."""
        return [messages.warning_text(self.name, warning) for warning in self.result.report["warnings"]]
