# SPDX-License-Identifier: GPL-3.0-or-later
"""The control mesh of this moment, from Object Mode, Sculpt Mode or in the midst of an edit. The source is only read."""

import bpy

from ..read.data import read_data
from ..read.mesh import read_mesh
from ..read.region import NONE_SELECTED, selected_faces
from ..read.source import control_mesh
from ..run.job_error import JobError


def read_arrays(source, settings, depsgraph):
    """The ControlArrays that `settings` (a snapshot) ask for."""
    with _mesh(source, settings, depsgraph) as mesh:
        return read_mesh(mesh)


def read_region(source, settings, depsgraph):
    """(r,) ids of the selected faces; None if all are to be faired."""
    if not settings.use_selection:
        return None
    with _mesh(source, settings, depsgraph) as mesh:
        region = selected_faces(mesh)
    if not len(region):
        raise JobError(f"{source.name}: {NONE_SELECTED}")
    return region


def read_surface_data(source, settings, depsgraph):
    """The SurfaceData that goes with the arrays."""
    with _mesh(source, settings, depsgraph) as mesh:
        return read_data(source, mesh, _is_evaluated(settings))


def _mesh(source, settings, depsgraph):
    return control_mesh(bpy.context, source, _is_evaluated(settings), depsgraph)


def _is_evaluated(settings):
    return settings.mesh_source == "EVALUATED" and not settings.use_selection
