# SPDX-License-Identifier: GPL-3.0-or-later
"""Cages over scans, by QuadriFlow."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

import bmesh
import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

from .blender import Context, Mesh, Object, column
from .errors import JobError
from .mesh import scans
from .mesh.object import linked_object, new_object, select_only
from .mesh.scans import Scan, read_scans
from .mesh.world_shape import transformed, world_matrix
from .mesh.write import write_faces
from .words import counted

# On a ball with noise of 0.3 % and 300 faces, 2,562 points give a surface that is 0.34 % off; with 100
# faces 0.17 %.
POINTS_A_FACE = 25
# QuadriFlow fails for fewer.
LEAST_CAGE_FACES = 20
VOXELS_AN_EDGE = 4  # of a cage over several scans
POINTS_ASKED = 10_000  # of a scan, whether a cage is near them
# Share of a scan's points that may be farther from its cage than an edge: strays.
LEFT_OUT = 1e-3


@dataclass(frozen=True)
class MadeCage:
    """A new cage, and its differences from the requested one."""

    object: Object
    is_whole: bool  # no part of the scan is farther from it than one of its edges
    is_finer: bool  # it has more faces, as fewer left out a part
    is_limited: bool  # it has fewer faces: one for `POINTS_A_FACE` points at most


def make_cage(context: Context, near: Sequence[Object], faces: int) -> MadeCage:
    """A new object with some `faces` quads over the scans `near`, or as many as their points allow, by
    QuadriFlow: of one scan in its place, of several in the world. It has more faces where fewer leave
    out a part, such as an ear. Raises JobError.
    """
    scan = read_scans(context, near)
    names = ", ".join(scan.name for scan in near)
    if 0 < len(scan.points) < LEAST_CAGE_FACES:
        raise JobError(
            f"{names}: Select a scan. This mesh has {counted(len(scan.points), 'point')}, and a cage at least"
            f" {LEAST_CAGE_FACES} faces."
        )
    most = max(len(scan.points) // POINTS_A_FACE, LEAST_CAGE_FACES)
    is_limited = faces > most
    faces = min(faces, most)
    if not scan.triangles.size:
        raise JobError(
            f"{names}: Draw a cage over it, and select it last. The scan has no faces, which QuadriFlow needs."
        )
    cage = _copy_of(context, near, scan)
    select_only(context, [cage])
    mesh = cage.data
    tried, is_whole = 0, False
    if len(near) == 1 or _unite(cage, faces):
        tried, is_whole = _make_quads_near(cage, scan, faces, most)
    if not tried:
        bpy.data.objects.remove(cage)
        bpy.data.meshes.remove(mesh)
        raise JobError(
            f"{names}: Close its holes first (Clean Scan), or draw a cage over it. QuadriFlow made no cage of it."
        )
    name = mesh.name
    bpy.data.meshes.remove(mesh)
    cage.data.name = name
    return MadeCage(cage, is_whole, tried > 1, is_limited)


def _make_quads_near(cage: Object, scan: Scan, faces: int, most: int) -> tuple[int, bool]:
    """Makes finer and finer meshes by QuadriFlow; returns their number, and whether near enough."""
    dense, made = cage.data, 0
    while True:
        before = cage.data
        cage.data = dense.copy()
        if not _make_quads(cage.data, faces):
            failed, cage.data = cage.data, before
            bpy.data.meshes.remove(failed)
            return made, False
        made += 1
        if before != dense:
            bpy.data.meshes.remove(before)
        is_whole = _is_near(cage, scan)
        if is_whole or faces == most:
            return made, is_whole
        faces = min(2 * faces, most)


def _copy_of(context: Context, near: Sequence[Object], scan: Scan) -> Object:
    if len(near) == 1:
        depsgraph = context.evaluated_depsgraph_get()
        mesh = cast(Mesh, bpy.data.meshes.new_from_object(near[0].evaluated_get(depsgraph)))
        mesh.name = f"{near[0].name} Cage"
        return new_object(context, near[0], mesh)
    mesh = cast(Mesh, bpy.data.meshes.new(f"{near[0].name} Cage"))
    write_faces(mesh, scan.points, scan.triangles, np.empty((0, 4), np.int32))
    mesh.update(calc_edges=True)
    return linked_object(context, mesh, near[0])


def _unite(joined: Object, faces: int) -> bool:
    """Makes one closed surface of scans that overlap, as fine as a cage with `faces` needs. False where they
    enclose nothing: then it has two sides, less than a voxel apart.
    """
    mesh = joined.data
    edge = _mean_edge(mesh, faces)
    mesh.remesh_voxel_size = size = edge / VOXELS_AN_EDGE
    bpy.ops.object.voxel_remesh()
    return scans.of_mesh(mesh).volume > size * column(mesh.polygons, "area").sum() / 2


def _mean_edge(mesh: Mesh, faces: int) -> float:
    return float(np.sqrt(column(mesh.polygons, "area").sum() / faces))


def _make_quads(mesh: Mesh, faces: int) -> bool:
    """Of the active object's mesh; holes that QuadriFlow leaves are closed."""
    try:
        bpy.ops.object.quadriflow_remesh(mode="FACES", target_faces=faces, use_preserve_sharp=False)
    except RuntimeError:
        return False
    if not 0 < len(mesh.polygons) <= 10 * faces:
        return False
    apart = 1e-6 * _mean_edge(mesh, len(mesh.polygons))
    edit = bmesh.new()
    edit.from_mesh(mesh)
    bmesh.ops.remove_doubles(edit, verts=list(edit.verts), dist=apart)
    bmesh.ops.dissolve_degenerate(edit, dist=apart, edges=list(edit.edges))
    open_edges = [edge for edge in edit.edges if edge.is_boundary]
    bmesh.ops.holes_fill(edit, edges=open_edges, sides=4)
    edit.to_mesh(mesh)
    edit.free()
    return True


def _is_near(cage: Object, scan: Scan) -> bool:
    """Whether the scan is no farther from the cage than one of its edges."""
    mesh = cage.data
    points = transformed(column(mesh.vertices, "co", width=3), np.array(world_matrix(cage)))
    ends = points[column(mesh.edges, "vertices", np.int32, 2)]
    edge = float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).mean())
    polygons = [face.vertices[:] for face in mesh.polygons]
    tree: Any = BVHTree.FromPolygons(points.tolist(), polygons)
    asked = scan.points[:: -(-len(scan.points) // POINTS_ASKED)].tolist()
    left_out = sum(tree.find_nearest(point, edge)[0] is None for point in asked)
    return left_out <= LEFT_OUT * len(asked)
