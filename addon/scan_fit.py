# SPDX-License-Identifier: GPL-3.0-or-later
"""The fair surface of a cage near scans: read, `discrete_fairing.fit`, a new object; and cages by QuadriFlow."""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any, cast

import bpy
import numpy as np

from . import core, errors, prediction, size
from .blender import Context, Mesh, Object
from .errors import JobError
from .mesh.begun import Begun
from .mesh.object import Reference, new_object, select_only
from .mesh.read import control_mesh, read_mesh
from .mesh.world_shape import transformed, world_matrix, world_shape
from .mesh.write import write_mesh
from .preferences import preferences
from .settings import Settings
from .transfer.lattice import edge_table, fine_edges
from .units import Units

SCAN_TYPES = {"MESH", "POINTCLOUD"}
# of the surface itself, or of vertices that a fit moves by itself
_NOT_OF_FITS = ("energy", "interpolation", "tolerance", "weights", "normals", "pad_size", "measure")


@dataclass(frozen=True)
class Scan:
    """Points in the world, and triangles between them; (0, 3) for point clouds."""

    points: np.ndarray
    triangles: np.ndarray


def read_scan(context: Context, target: Object) -> Scan:
    """As the window shows it: with modifiers, in the world."""
    depsgraph = context.evaluated_depsgraph_get()
    owner = target.evaluated_get(depsgraph)
    matrix = np.array(world_matrix(target), dtype=np.float64)
    if target.type == "POINTCLOUD":
        cloud: Any = owner.data
        points = np.empty(3 * len(cloud.points), np.float32)
        cloud.points.foreach_get("co", points)
        return Scan(
            transformed(points.reshape(-1, 3).astype(np.float64), matrix),
            np.empty((0, 3), np.int64),
        )
    mesh = cast(Mesh, owner.to_mesh())
    try:
        points = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", points)
        mesh.calc_loop_triangles()
        triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
    finally:
        owner.to_mesh_clear()
    corners = triangles.reshape(-1, 3).astype(np.int64)
    if np.linalg.det(matrix[:3, :3]) < 0:
        corners = corners[:, ::-1]
    return Scan(transformed(points.reshape(-1, 3).astype(np.float64), matrix), corners)


def joined(scans: Sequence[Scan]) -> tuple[np.ndarray, np.ndarray | None]:
    """All points, and all triangles; None where a scan has none: its points have no normals."""
    points = np.concatenate([scan.points for scan in scans])
    begins = np.cumsum([0, *(len(scan.points) for scan in scans[:-1])])
    if not all(len(scan.triangles) for scan in scans):
        return points, None
    return points, np.concatenate(
        [scan.triangles + begin for scan, begin in zip(scans, begins, strict=True)]
    )


def make_cage(context: Context, scan: Object, faces: int) -> Object:
    """A new object with some `faces` quads over the scan, by QuadriFlow. Raises JobError."""
    depsgraph = context.evaluated_depsgraph_get()
    mesh = cast(Mesh, bpy.data.meshes.new_from_object(scan.evaluated_get(depsgraph)))
    mesh.name = f"{scan.name} Cage"
    cage = new_object(context, scan, mesh)
    select_only(context, [cage])
    try:
        bpy.ops.object.quadriflow_remesh(mode="FACES", target_faces=faces, use_preserve_sharp=False)
        made = len(cage.data.polygons)
    except RuntimeError:
        made = 0
    if not made or made > 10 * faces:
        bpy.data.objects.remove(cage)
        bpy.data.meshes.remove(mesh)
        raise JobError(
            f"{scan.name}: QuadriFlow made no cage of it. Close its holes first (Clean Scan), or draw a cage over it."
        )
    return cage


class FitJob:
    """One cage and its scans: read, fitted on any thread, then written."""

    def __init__(
        self,
        context: Context,
        cage: Object,
        scans: Sequence[Object],
        settings: Settings,
        tolerance: float | None,
    ) -> None:
        self.name, self._cage = cage.name, Reference(cage)
        self._units = Units.of(context.scene)
        matrix = np.array(world_matrix(cage), dtype=np.float64)
        mirrored = np.linalg.det(matrix[:3, :3])
        if mirrored == 0:
            raise JobError(f"{cage.name}: its scale is 0 along an axis. Give it another scale.")
        self._shape = world_shape(cage)
        with control_mesh(context, cage) as mesh:
            self._arrays = read_mesh(mesh)
        self._begun = Begun.of("Run Fair Surface on Scan", cage, self._arrays)
        points, triangles = joined([read_scan(context, scan) for scan in scans])
        self._settings = settings
        # the scan goes to where the cage's own coordinates are, in the size of the world
        points = self._shape.of(transformed(points, np.linalg.inv(matrix)))
        if triangles is not None and mirrored < 0:
            triangles = triangles[:, ::-1]
        sent = core.fair_arguments(self._shape.of_arrays(self._arrays), settings, preferences())
        self._arguments = {k: v for k, v in sent.items() if k not in _NOT_OF_FITS}
        self._arguments |= {
            "points": points,
            "triangles": triangles,
            "tolerance": tolerance,
        }
        self.triangles = size.triangle_count(self._arrays.face_sizes, settings.levels)
        self.work = self.triangles + len(points)
        self.result: Any = None

    @property
    def _key(self) -> Hashable:
        """For predictions."""
        return "fit", self._cage.key

    @property
    def predicted_seconds(self) -> float:
        """How long `compute` will take."""
        return prediction.seconds("FIT", self.work, self._key)

    def compute(self, **watchers: Any) -> None:
        """Runs the core; `watchers` are its `monitor` and `progress`."""
        begun = perf_counter()
        with errors.explained(self.name):
            self.result = core.module().fit(**self._arguments, **watchers)
        self.result.vertices = self._shape.back(
            self.result.vertices, self._arguments["vertices"], self._arrays.positions
        )
        self._edges = edge_table(self.result.faces)
        self._taken = perf_counter() - begun

    def why_outdated(self, context: Context) -> str:
        """Why what was computed does not fit any more, in one sentence; empty if it does."""
        return self._begun.why_outdated(context)

    def write(self, context: Context) -> Object:
        """Makes the surface as a new object beside the cage, and returns it."""
        result, cage = self.result, cast(Object, self._cage.find())
        creases = fine_edges(result.faces, result.crease_edges, self._settings.levels)
        mesh = write_mesh(f"{self.name} Fit", result, creases, cage.data.materials, self._edges)
        target = new_object(context, cage, mesh)
        if self._settings.shade_smooth:
            mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), bool))
        prediction.note("FIT", self.work, self._taken, self._key)
        return target

    def said(self) -> str:
        """How well the surface fits, in words."""
        found = self.result
        length = self._units.lengths(found.within[0])
        text = f"Within {length(found.within[0])} of 95 % of the scan; its noise is about {length(found.noise)}."
        coarse, strays = len(found.too_coarse), len(found.outliers)
        bare = int(np.count_nonzero(found.coverage == 0))
        if coarse:
            text += f" {coarse} {'face is' if coarse == 1 else 'faces are'} too coarse."
        if bare:
            text += f" {bare} {'face has' if bare == 1 else 'faces have'} no points."
        if strays:
            text += f" {strays} {'point is a stray' if strays == 1 else 'points are strays'}."
        return text

    def warnings(self) -> list[str]:
        """What the user should know, a sentence each."""
        return [
            errors.warning_text(self.name, warning) for warning in self.result.report["warnings"]
        ]
