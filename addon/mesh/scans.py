# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads scans as arrays: meshes, point clouds and instances, with modifiers, in the world."""

import zlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, cast

import bpy
import numpy as np

from ..blender import Context, Mesh, Object, column
from ..errors import REMEDIES, JobError
from ..triangles import normals
from ..words import counted
from .read import control_mesh
from .world_shape import matrix_relative_to, transformed, world_matrix, world_shape

MOST_LIVE = 20_000  # points of a scan that are used during edits


@dataclass(frozen=True)
class Scan:
    """Points, with triangles, or with normals, or with neither."""

    points: np.ndarray  # (S, 3) float64
    triangles: np.ndarray  # (T, 3) int64
    normals: np.ndarray | None = None  # (S, 3), outwards, of any length; zero if unknown

    def in_shape_of(self, cage: Object) -> "Scan":
        """The scan in the cage's coordinates, at its size in the world; raises JobError."""
        matrix = np.array(world_matrix(cage), dtype=np.float64)
        if np.linalg.matrix_rank(matrix) < 4:
            raise JobError(
                f"{cage.name}: Type a scale other than 0 in the sidebar (N, Item). The cage is flat by its scale."
            )
        moved = self.moved(np.linalg.inv(matrix))
        return Scan(world_shape(cage).of(moved.points), moved.triangles)

    def moved(self, matrix: np.ndarray) -> "Scan":
        """The scan moved by a (4, 4) matrix; triangles of a mirror image still point outwards."""
        turned = np.linalg.det(matrix[:3, :3]) < 0
        triangles = self.triangles[:, ::-1] if turned else self.triangles
        return Scan(transformed(self.points, matrix), triangles)

    def thinned(self) -> "Scan":
        """A subset of points that is fast enough for edits; triangles are dropped with their sides."""
        step = -(-len(self.points) // MOST_LIVE)
        outward = normals(self.points, self.triangles)[::step] if len(self.triangles) else None
        return Scan(self.points[::step], np.empty((0, 3), np.int64), outward)

    @property
    def volume(self) -> float:
        """The volume that a closed scan encloses; negative if its normals point inwards."""
        corners = (self.points - self.points.mean(axis=0))[self.triangles]
        return float(np.linalg.det(corners).sum()) / 6 if len(corners) else 0.0

    @property
    def arguments(self) -> dict[str, Any]:
        triangles = self.triangles if len(self.triangles) else None
        return {"points": self.points, "triangles": triangles, "normals": self.normals}


def is_scan(target: Object) -> bool:
    """Whether the object may be a scan; an empty may be one if it instances a collection."""
    if target.type == "EMPTY":
        return target.instance_type == "COLLECTION"
    return target.type in {"MESH", "POINTCLOUD"}


def read_scans(context: Context, targets: Sequence[Object]) -> Scan:
    """All targets as one scan, as shown in the window: with modifiers and instances, in the world."""
    parts = [part.moved(matrix) for part, matrix in _parts(context, targets)]
    begins = np.cumsum([0, *(len(part.points) for part in parts)])
    return Scan(
        np.concatenate([np.empty((0, 3)), *(part.points for part in parts)]),
        np.concatenate(
            [
                np.empty((0, 3), np.int64),
                *(part.triangles + begin for part, begin in zip(parts, begins)),
            ]
        ),
    )


def require_finite(points: np.ndarray, names: str) -> None:
    """Raises JobError where a point (S, 3) of the scans `names` has no finite position."""
    lost = int(np.count_nonzero(~np.isfinite(points).all(axis=1)))
    if lost:
        raise JobError(
            f"{names}: {REMEDIES['NON_FINITE']}."
            f" {counted(lost, '{point of the scan has|points of the scan have}')} no finite position."
        )


def made_of(context: Context, targets: Sequence[Object], cage: Object) -> dict[str, Any]:
    """A checksum of the scans in their own coordinates, and their transforms from the cage."""
    places, total = [], 0
    for part, matrix in _parts(context, targets):
        for array in (part.points, part.triangles):
            total = zlib.crc32(np.ascontiguousarray(array).tobytes(), total)
        places.append(matrix_relative_to(cage, matrix).tolist())
    return {"shape": total, "places": places}


def are_moved(made: dict[str, Any], now: dict[str, Any]) -> bool:
    """Whether two states of `made_of` differ by more than the rounding of Blender's matrices."""
    before, after = (np.array(one["places"]) for one in (made, now))
    return bool(np.abs(before - after).max(initial=0.0) > 1e-5 * np.abs(before).max(initial=0.0))


def watched(targets: Iterable[Object]) -> Iterator[bpy.types.ID]:
    """The data-blocks whose changes affect the result of `read_scans`."""
    for target in targets:
        yield target
        if target.data is not None:
            yield target.data
        if target.instance_collection is not None:
            yield from watched(cast(Iterable[Object], target.instance_collection.all_objects))


def with_faces(context: Context, target: Object) -> tuple[np.ndarray, np.ndarray]:
    """One object as shown: points (n, 3) in the world, and triangles (m, 3); JobError if there are none."""
    found = read_scans(context, [target])
    if not len(found.triangles):
        raise JobError(f"{target.name}: {REMEDIES['EMPTY_MESH']}. It has no faces.")
    return found.points, found.triangles


def in_metres(context: Context, target: Object) -> tuple[np.ndarray, np.ndarray]:
    """The same in metres."""
    points, triangles = with_faces(context, target)
    return points * context.scene.unit_settings.scale_length, triangles


def _parts(context: Context, targets: Sequence[Object]) -> list[tuple[Scan, np.ndarray]]:
    """Each scan in its own coordinates, and its (4, 4) matrix to the world."""
    own = [part for target in targets for part in _own(context, target)]
    return own + _instances(context, targets)


def _own(context: Context, target: Object) -> Iterator[tuple[Scan, np.ndarray]]:
    matrix = np.array(world_matrix(target), dtype=np.float64)
    if target.type == "POINTCLOUD":
        owner = target.evaluated_get(context.evaluated_depsgraph_get())
        yield _of_cloud(owner.data), matrix
    elif target.type == "MESH":
        with control_mesh(context, target, evaluated=True) as mesh:
            yield of_mesh(mesh), matrix


def _instances(context: Context, targets: Iterable[Object]) -> list[tuple[Scan, np.ndarray]]:
    """Instances that collections, nodes and instancers among the `targets` create."""
    found, meshes = [], {}
    wanted = {target.name_full for target in targets}
    depsgraph: Any = context.evaluated_depsgraph_get()
    for instance in depsgraph.object_instances:
        if not instance.is_instance or instance.parent.original.name_full not in wanted:
            continue
        owner, matrix = instance.object, np.array(instance.matrix_world, dtype=np.float64)
        if owner.type not in {"MESH", "POINTCLOUD"}:
            continue
        key = owner.data.as_pointer()
        if key not in meshes:
            meshes[key] = (_of_cloud if owner.type == "POINTCLOUD" else of_mesh)(owner.data)
        found.append((meshes[key], matrix))
    return found


def of_mesh(mesh: Mesh) -> Scan:
    """The scan of a mesh, in its own coordinates."""
    points = column(mesh.vertices, "co", width=3).astype(np.float64)
    mesh.calc_loop_triangles()
    return Scan(points, column(mesh.loop_triangles, "vertices", np.int32, 3).astype(np.int64))


def _of_cloud(cloud: Any) -> Scan:
    points = column(cloud.points, "co", width=3).astype(np.float64)
    return Scan(points, np.empty((0, 3), np.int64))
