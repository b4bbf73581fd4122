# SPDX-License-Identifier: GPL-3.0-or-later
"""Fills holes in their own mesh with the fairest surface: finds the holes, makes the faces."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, cast

import bmesh
import numpy as np

from .. import core, errors
from ..blender import Context, Object, column
from ..check.defects import check_object, entry, store_defects
from ..errors import JobCancelled, JobError
from ..mesh.edited import edited, select_nothing
from ..mesh.timed_run import TimedRun
from ..mesh.write_filling import cut_sides, with_new, write_hole
from ..transfer.filling import Patch
from ..transfer.hole_loops import (
    Side,
    faces_left,
    holes_in,
    sides_of,
    unclear_edges,
    where_faces_were,
)
from ..triangles import marked
from ..units import Units
from ..words import counted


@dataclass(frozen=True)
class FillOptions:
    joint: str  # POSITION, TANGENT, CURVATURE; FLAT: no new vertices, and a sharp rim
    energy: str
    density: float
    # in Object Mode: wider holes stay open, in scene units; 0: borders of sheets stay open
    largest: float
    # in Edit Mode: whether to replace the selected faces, or to fill holes at selected border edges
    replaces: bool
    noisy: bool = False  # whether the faces around are measured, with noise
    edge: tuple[int, int] | None = None  # only the hole with this edge, whatever else is selected


class HoleJob(TimedRun):
    """The holes of one object: read, filled on any thread, applied. `result`: the package's Filled;
    `error`: why nothing can be filled, found while computing.
    """

    again = "Fill"

    def __init__(self, context: Context, target: Object, options: FillOptions) -> None:
        """Reads the holes; raises JobError if that is impossible."""
        self._options, self.kind = options, options.energy
        self.error: JobError | None = None
        with self._reading(context, target) as mesh:
            arrays = self.arrays
            selects = self._editing and options.edge is None
            gone = column(mesh.polygons, "select", bool) & (selects and options.replaces)
            edges = column(mesh.edges, "select", bool) & selects
        self._gone = gone
        self._points = self.shape.of(arrays.positions)
        self._faces = faces_left(arrays, gone)
        with errors.explained(self.name, errors.OF_HOLES):
            holes = holes_in(self._points, self._faces)
        loops = [loop for hole in holes for loop in hole]
        unclear, chosen = unclear_edges(arrays, gone, loops), set[Side]()
        if options.edge is not None:
            chosen = {frozenset(options.edge)}
        elif self._editing and not options.replaces:
            chosen = set(map(frozenset, arrays.edges[edges].tolist()))
        if self._editing and not options.replaces:
            unclear = [side for side in unclear if side in chosen]
        self.unclear = len(unclear)  # border edges around ambiguous holes
        if options.edge is None and not self._editing:
            wanted = core.module().holes_to_fill(self._points, self._faces, holes, options.largest)
            self._holes = [[loop.tolist() for loop in hole] for hole in wanted]
        elif options.edge is None and options.replaces:
            self._holes = where_faces_were(arrays, gone, loops)
        else:
            self._holes = [h for h in holes if not all(map(chosen.isdisjoint, map(sides_of, h)))]
        if not self._holes:
            rims = self._points[np.unique(arrays.border_edges)]
            units = Units.of(context.scene)
            why = _why_none(options, self._editing, self.unclear, rims, units)
            raise JobError(f"{self.name}: {why}")
        self.triangles = sum(_triangles_in(sum(map(len, h)), options.density) for h in self._holes)

    @property
    def closes_caps(self) -> bool:
        """Whether each hole lies in a plane and the faces around stand across it, as at caps and
        transoms. Small rims may be planar by chance, unless the user has chosen them in Edit Mode.
        """
        if self._editing and self._options.replaces:
            return False
        least = 0 if self._editing else _BY_CHANCE
        world = core.measured(self.shape.of_arrays(self.arrays))
        return all(sum(map(len, hole)) > least and _is_cap(world, hole) for hole in self._holes)

    def flatten(self) -> None:
        """Fills with flat faces, whatever the joint."""
        self._options = replace(self._options, joint="FLAT")

    @property
    def _is_flat(self) -> bool:
        return self._options.joint == "FLAT"

    @property
    def _editing(self) -> bool:
        return self._mode == "EDIT"

    @property
    def energy(self) -> str:
        """The requested energy, as the core names it."""
        return self._options.energy.lower()

    def _compute(self, watchers: dict[str, Any]) -> None:
        try:
            with errors.explained(self.name, errors.OF_HOLES):
                self.result = core.module().fill_holes(
                    self._points,
                    self._faces,
                    holes=self._holes,
                    joint="position" if self._is_flat else self._options.joint.lower(),
                    energy=self.energy,
                    density=0.0 if self._is_flat else self._options.density,
                    rim="noisy" if self._options.noisy else "exact",
                    **watchers,
                )
        except JobCancelled:
            raise
        except JobError as error:
            self.error = error
            return
        none = np.empty((0, 3))
        new = np.concatenate([none, *(hole.vertices for hole in self.result.holes)])
        self._patches = [Patch.of([h.faces], self._points, new) for h in self.result.holes]
        self._places = self.shape.back(new, none, none)  # (k, 3) in the object's coordinates
        if not (self.result.holes or self.result.cuts):
            self.error = JobError(f"{self.name}: {self.left_text}", self.skipped[0]["code"])

    def apply(self) -> None:
        target = cast(Object, self.reference.find())
        if not self._editing:
            select_nothing(target)
        with edited(target) as bm:
            bm.verts.ensure_lookup_table()
            cuts = self.result.cuts.items()
            sides = [[bm.verts[v] for v in (a, *on, b)] for (a, b), on in cuts]
            gone = np.flatnonzero(self._gone)
            _write(bm, gone, self._patches, self._places, self._is_flat)
            cut_sides(bm, sides)
        self.note()

    @property
    def skipped(self) -> list[dict[str, Any]]:
        """The skipped holes of a finished job, like the defects of Check Mesh."""
        return [] if self.result is None else list(map(_skipped, self.result.skipped))

    @property
    def left_text(self) -> str:
        """Which holes could not be filled, and why, as a sentence; empty if all are filled."""
        if not self.skipped:
            return ""
        why = _listed(self.result.reasons).rstrip(".")
        return f"{counted(len(self.skipped), 'hole')} left, listed in the panel Check: {why}"

    def check_again(self, context: Context) -> None:
        """Checks again where holes were listed, skipped or ambiguous, for the panel's buttons."""
        target = self.reference.find()
        if target is None or not (self.skipped or self.unclear or self._options.edge is not None):
            return
        known = check_object(context, target)
        if self.skipped:
            codes = {defect["code"] for defect in known}
            new = [defect for defect in self.skipped if defect["code"] not in codes]
            store_defects(context, target, known + new)


def _skipped(hole: Any) -> dict[str, Any]:
    code = errors.VERTEX_ON_EDGE if hole.cure == "cut" else hole.code
    return entry(code, hole.kind, hole.elements, "error", hole.message)


_BY_CHANCE = 6  # vertices of a rim that may be planar by chance: twice as many as determine a plane
_PLANAR = 1e-3  # largest distance of a rim's vertices from its plane, relative to its width


def _is_cap(mesh: Any, hole: list[list[int]]) -> bool:
    """Whether the rim lies in a plane that the faces around cross at more than 45 degrees on average."""
    ids = [v for loop in hole for v in loop]
    rim = mesh.positions[ids]
    away = rim - rim.mean(axis=0)
    _, sizes, ways = np.linalg.svd(away, full_matrices=False)
    if len(sizes) < 3 or np.abs(away @ ways[2]).max() > _PLANAR * np.ptp(away @ ways[0]):
        return False
    on_rim = marked(ids, len(mesh.positions))
    around = np.flatnonzero(np.add.reduceat(on_rim[mesh.corners], mesh.offsets[:-1]) >= 2)
    normals = mesh.face_normals[around]
    return bool(len(around)) and float(np.abs(normals @ ways[2]).mean()) < np.sqrt(0.5)


def _triangles_in(edges: int, density: float) -> int:
    """Number of equilateral triangles in a round flat hole with so many edges."""
    return edges + round((edges * density) ** 2 / (np.sqrt(3.0) * np.pi))


def _why_none(
    options: FillOptions, editing: bool, unclear: int, rims: np.ndarray, units: Units
) -> str:
    """The error, as a sentence. `rims`: (k, 3) all border vertices."""
    if options.edge is not None:
        return "Press Check Mesh again: this hole is no longer there"
    if unclear:
        return _unclear_text(unclear)
    if not editing and not len(rims):
        return "Delete faces first: there is no hole, every edge has a face on both sides"
    if not editing and options.largest > 0.0:
        most = units.lengths(options.largest)(options.largest)
        return f"Raise Largest Hole: there is no hole of a width of at most {most}"
    if not editing and 2 * len(np.unique(rims, axis=0)) <= len(rims):
        return "Merge vertices by distance first, or use Clean Scan: its faces are not joined"
    if not editing:
        return "Set Largest Hole to a width, or select the border in Edit Mode: it seems to be that of a sheet"
    if options.replaces:
        return "Select faces with others around them: the selected ones leave no hole"
    return "Select a border edge of a hole, or in Face Mode faces to be replaced: no such edge is selected"


def _unclear_text(count: int) -> str:
    edges = counted(count, "{border edge is|border edges are}")
    return (
        f"Run Check Mesh, which shows where: {edges} around no hole, because more than two faces meet "
        "there at an edge, or faces point different ways"
    )


def _write(
    bm: Any, gone: np.ndarray, patches: list[Patch], places: np.ndarray, flat: bool = False
) -> None:
    """Makes the filling, selected, in place of the faces `gone` (ids). `flat`: its rim becomes sharp."""
    bm.verts.ensure_lookup_table()
    rims = [[bm.verts[v] for v in patch.rim.tolist()] for patch in patches]
    if len(gone):
        bm.faces.ensure_lookup_table()
        bmesh.ops.delete(bm, geom=[bm.faces[f] for f in gone.tolist()], context="FACES")
    made: list[Any] = []
    at = 0
    for patch, rim in zip(patches, rims, strict=True):
        its = places[at : at + len(patch.fresh)]
        made += write_hole(bm, patch, with_new(bm, patch, rim, its))
        at += len(its)
    for face in made:
        face.normal_update()
        face.select_set(True)
    if flat:
        new = set(made)
        for face in made:
            face.smooth = False
            for edge in face.edges:
                edge.smooth = edge.smooth and all(other in new for other in edge.link_faces)


# What is said of so many filled holes, from the core's report of each and the requested energy.
_REMARKS: tuple[tuple[Callable[[Any, str], bool], str], ...] = (
    (
        lambda hole, energy: hole.energy not in (energy, "none"),
        "{} filled with Bending: the chosen Fairness found no surface there",
    ),
    (
        lambda hole, _: hole.energy == "none" and not hole.converged,
        "{} filled with flat triangles: every fairer surface folds at this rim",
    ),
    (
        lambda hole, _: hole.folds > 0,
        "The filling of {} folds: erase more faces around it, and fill again",
    ),
    (
        lambda hole, _: hole.crossings > 0,
        "The filling of {} passes through other faces: erase those in its way, or fill by hand",
    ),
)


def fill_warnings(done: list[HoleJob]) -> list[str]:
    """Warnings about the fillings of applied jobs, a sentence each."""
    unclear = sum(job.unclear for job in done)
    said = [_unclear_text(unclear)] if unclear else []
    for is_so, sentence in _REMARKS:
        count = sum(is_so(hole, job.energy) for job in done for hole in job.result.holes)
        if count:
            said.append(sentence.format(counted(count, "hole")))
    return said


def _listed(reasons: list[str]) -> str:
    """The reasons, each once, the most frequent first; no more than users read."""
    ranked = sorted(set(reasons), key=lambda reason: (-reasons.count(reason), reason))
    return "; ".join(ranked[:3]) + ("; …" if len(ranked) > 3 else "")
