# SPDX-License-Identifier: GPL-3.0-or-later
"""Fairs selected faces in their own mesh: moves its vertices.

Only the selection and the faces near it are computed.
"""

from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np

from .. import core, errors, size
from ..blender import Context, Object, column
from ..check.faults import find_faults_in_place
from ..errors import JobError
from ..mesh.edited import edited
from ..mesh.read import selected_faces
from ..mesh.timed_run import TimedRun
from ..preferences import of_runs
from ..settings import Settings
from ..transfer.attributes import AttributeTransfer
from ..transfer.cut_out import cut_out, grown, inside
from ..units import Units
from . import noise
from .fair import run_warnings

# levels of the surface if only its control vertices are needed
_UNSEEN_LEVELS = 2
# rings of faces that determine the continuation
_RINGS = {"POSITION": 0, "TANGENT": 1, "CURVATURE": 2}


@dataclass(frozen=True)
class InPlaceOptions:
    joint: str  # POSITION, TANGENT, CURVATURE
    energy: str
    tension: float
    factor: float = 1.0  # the share of the way that they move
    # whether the vertices are measured, so that the surface passes near them
    measured: bool = False
    noise: float = 0.0  # their noise, rms along the normals, a length; 0: estimated


class InPlaceJob(TimedRun):
    """The selected faces of one object in Edit Mode: read, computed on any thread, then applied."""

    again = "Fair"

    def __init__(
        self, context: Context, source: Object, settings: Settings, options: InPlaceOptions
    ) -> None:
        """Reads the selected faces, in Object Mode all. `settings`: those that `options` lacks. Raises
        JobError.
        """
        self._options, self.kind = options, options.energy
        self._units = Units.of(context.scene)
        self._preferences = of_runs()  # arguments are also made on the computing thread
        with self._reading(context, source) as mesh:
            chosen = np.full(len(self.arrays.face_sizes), source.mode != "EDIT")
            if source.mode == "EDIT":
                chosen[selected_faces(mesh, source.name)] = True
        near = grown(self.arrays, chosen, _RINGS[options.joint])
        free = inside(self.arrays, chosen)
        _refuse(source.name, self.arrays, chosen, free, options)
        self._chosen = chosen
        self._part = part = cut_out(self.arrays, near)
        self._asked = asked = _settings(settings, options)
        self.triangles = size.triangle_count(part.arrays.face_sizes, asked.levels)
        self._arguments = self._arguments_of(part.arrays)
        # CORNERS means corners of the mesh; the selection's own do not count
        if settings.boundary == "CORNERS":
            whole = core.border_corners(self.shape.of_arrays(self.arrays))
            corners = np.isin(part.vertices, whole)
            given = self._arguments["corner_vertices"]
            self._arguments["corner_vertices"] = np.union1d(given, np.flatnonzero(corners))
        self._free = free[part.vertices]
        if not options.measured:
            self._arguments["interpolation"] = "approximate"
            self._arguments["weights"] = np.where(free[part.vertices], 0.0, np.inf)

    def _arguments_of(self, arrays: Any) -> dict[str, Any]:
        world = self.shape.of_arrays(arrays)
        return core.fair_arguments(world, self._asked, self._preferences)

    def _smoothed(self, watchers: dict[str, Any]) -> tuple[Any, float]:
        """The measured vertices without noise, at level 0, and the noise, found on a part."""
        part, arguments = self._part.arrays, self._arguments
        theirs = self._chosen[self._part.faces]
        tried = noise.sample(part, theirs)
        if tried.sum() < theirs.sum():
            small = cut_out(part, tried)
            own = self._arguments_of(small.arrays)
            free = inside(part, tried)[small.vertices] & self._free[small.vertices]
        else:
            own, free = arguments, self._free
        watched = watchers.get("progress"), watchers.get("monitor"), arguments["threads"]
        runs = core.module().watching.SeveralRuns(*watched)
        found = noise.amount(own, free, self._options.noise, runs)
        made = noise.smoothed(arguments, self._free, found.weight, runs)
        return made, found.noise

    def _compute(self, watchers: dict[str, Any]) -> None:
        arguments, part = self._arguments, self._part
        self._noise = 0.0  # of measured vertices, a length
        with errors.explained(self.name, errors.WITHOUT_MENDING):
            if self._options.measured:
                result, self._noise = self._smoothed(watchers)
            else:
                result = core.module().fair(**arguments, **watchers)
        result.vertices = self._part_of_the_way(result.vertices, arguments["vertices"])
        # (N, 3) in the object's coordinates, the vertices of the part first
        self._points = self.shape.back(
            result.vertices, arguments["vertices"], part.arrays.positions
        )
        transfer = AttributeTransfer(result, part.arrays, self._asked.levels)
        world = self.shape.of_arrays(part.arrays)
        theirs = self._chosen[part.faces]
        self._faults = find_faults_in_place(result, transfer, world, theirs, self._options.joint)
        self.result = result

    def _part_of_the_way(self, vertices: np.ndarray, before: np.ndarray) -> np.ndarray:
        """Positions of the part between `before` and the fairest place; others keep their bits."""
        if self._options.factor == 1.0:
            return vertices
        vertices = vertices.copy()
        vertices[: len(before)] = before + self._options.factor * (vertices[: len(before)] - before)
        return vertices

    def warnings(self) -> list[str]:
        sentences = run_warnings(self.name, self.result.report, self._options.energy)
        counts = self._faults.counts
        if counts:
            # Near is no option here, and removing noise has neither Fairness nor Tension
            settings = replace(self._asked, interpolation="APPROXIMATE")
            if self._options.measured:
                settings = replace(settings, energy="THIN_PLATE", tension=1.0)
            sentences.append(errors.faults_in_place_text(self.name, counts, settings))
        return sentences

    @property
    def notes(self) -> list[str]:
        if not self._options.measured:
            return []
        text = self._units.lengths(self._noise)(self._noise)
        return [f"{self.name}: noise of {text} (rms) removed."]

    def apply(self) -> None:
        """Moves the faces that were read."""
        source, vertices = cast(Object, self.reference.find()), self._part.vertices
        if source.mode != "EDIT":  # without a copy: scans are large
            points = column(source.data.vertices, "co", width=3)
            points[vertices] = self._points[: len(vertices)]
            source.data.vertices.foreach_set("co", points.ravel())
            source.data.update()
        else:
            with edited(source) as bm:
                bm.verts.ensure_lookup_table()
                for index, point in zip(vertices.tolist(), self._points.tolist()):
                    bm.verts[index].co = point
                bm.normal_update()
        self.note()


def _refuse(
    name: str, arrays: Any, chosen: np.ndarray, free: np.ndarray, options: InPlaceOptions
) -> None:
    if not free.any():
        raise JobError(
            f"{name}: Select more faces. No vertex lies inside of the selection, so none can move."
        )
    if not options.measured and floats(arrays, free):
        raise JobError(
            f"{name}: Leave out some faces of each part. One is selected whole, so nothing holds it."
        )


def floats(arrays: Any, free: np.ndarray) -> bool:
    """Whether some connected part of the mesh `arrays` has only `free` vertices, (n,) bool."""
    part = core.module().arrays.connected_parts(len(free), arrays.edges)
    return bool((np.bincount(part, ~free) == 0).any())


def _settings(settings: Settings, options: InPlaceOptions) -> Settings:
    return replace(
        settings,
        levels=0 if options.measured else _UNSEEN_LEVELS,
        # a scan has only the creases that the user has marked
        use_sharp_edges=settings.use_sharp_edges or options.measured,
        joint=options.joint,
        energy=options.energy,
        tension=options.tension,
        interpolation="EXACT",
        boundary="CURVE" if settings.boundary == "CORNERS" else settings.boundary,
        repair="REFUSE",
        symmetry_plane="NONE",
    )
