# SPDX-License-Identifier: GPL-3.0-or-later
"""Cages over scans: of quads by QuadriFlow, or the scan with fewer faces."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

import bmesh
import bpy
import numpy as np
from mathutils import Matrix
from mathutils.bvhtree import BVHTree

from ..blender import Context, Mesh, Object, column
from ..errors import JobError
from ..mesh import scans
from ..mesh.object import linked_object, new_object, select_only
from ..mesh.scans import Scan, read_scans
from ..mesh.world_shape import transformed, world_matrix
from ..mesh.write import write_faces
from ..words import counted

# On a ball with noise of 0.3 % and 300 faces, 2,562 points give a surface that is 0.34 % off; with 100
# faces 0.17 %.
POINTS_A_FACE = 25
# QuadriFlow fails for fewer.
LEAST_CAGE_FACES = 20
# QuadriFlow refuses edges shorter than 1e-4, in any unit: it gets the scan with mean edges of about this length.
MEAN_EDGE = 2.0**12
MOST_FINER = 4  # times as many quads as were asked for, where fewer leave out a part
JOINED = 0.7  # radians: triangles of a cage become a quad if it is as flat and as square as this
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
    is_by_quads: bool  # otherwise QuadriFlow made none, or left out a part, and it has triangles
    is_limited: bool  # it has fewer faces: one for `POINTS_A_FACE` points at most


def make_cage(context: Context, near: Sequence[Object], faces: int) -> MadeCage:
    """A new object with some `faces` over the scans `near`, or as many as their points allow: of one scan in its
    place, of several in the world. Its quads are QuadriFlow's; where these leave out a part, such as an
    ear, it is the scan with fewer faces. Raises JobError.
    """
    scan = read_scans(context, near)
    names = ", ".join(scan.name for scan in near)
    scans.require_finite(scan.points, names)  # QuadriFlow does not end then
    if len(scan.points) < LEAST_CAGE_FACES:
        raise JobError(
            f"{names}: Select a scan. This mesh has {counted(len(scan.points), 'point')}, and a cage at least"
            f" {LEAST_CAGE_FACES} faces."
        )
    most = max(len(scan.points) // POINTS_A_FACE, LEAST_CAGE_FACES)
    is_limited = faces > most
    faces = min(faces, most)
    a, b, c = scan.points[scan.triangles].swapaxes(0, 1)
    if not np.cross(b - a, c - a).any():
        raise JobError(
            f"{names}: Draw a cage over it, and select it last. The scan has no faces with an area to make one of."
        )
    cage = _copy_of(context, near, scan)
    select_only(context, [cage])
    dense = cage.data
    if len(near) > 1 and not _unite(cage, faces):
        raise JobError(
            f"{names}: Close their holes first (Clean Scan), or draw a cage over them. Together they enclose nothing."
        )
    tried, is_whole = _make_quads_near(cage, scan, faces, min(MOST_FINER * faces, most))
    is_by_quads = is_whole
    if not is_whole:
        tried = 1
        _replace(cage, _with_fewer_faces(context, cage, dense, faces), keep=dense)
        is_whole = _is_near(cage, scan)
    name = dense.name
    bpy.data.meshes.remove(dense)
    cage.data.name = name
    return MadeCage(cage, is_whole, tried > 1, is_by_quads, is_limited)


def _make_quads_near(cage: Object, scan: Scan, faces: int, most: int) -> tuple[int, bool]:
    """Makes finer and finer meshes by QuadriFlow; returns their number, and whether near enough."""
    dense, made = cage.data, 0
    while True:
        _replace(cage, dense.copy(), keep=dense)
        if not _make_quads(cage.data, faces):
            return made, False
        made += 1
        is_whole = _is_near(cage, scan)
        if is_whole or faces >= most:
            return made, is_whole
        faces = min(2 * faces, most)


def _replace(cage: Object, mesh: Mesh, keep: Mesh) -> None:
    """Gives `cage` another mesh; the one before goes, unless it is the mesh to `keep`."""
    before, cage.data = cage.data, mesh
    if before != keep:
        bpy.data.meshes.remove(before)


def _with_fewer_faces(context: Context, cage: Object, dense: Mesh, faces: int) -> Mesh:
    """The `dense` mesh with two triangles a face; those become one quad that lie and fit well."""
    cage.data, before = dense, cage.data
    modifier = cast(bpy.types.DecimateModifier, cage.modifiers.new("Fewer", "DECIMATE"))
    triangles = sum(len(polygon.vertices) - 2 for polygon in dense.polygons)
    modifier.ratio = min(2 * faces / triangles, 1.0)
    edit = bmesh.new()
    edit.from_object(cage, context.evaluated_depsgraph_get())
    cage.modifiers.remove(modifier)
    cage.data = before
    bmesh.ops.join_triangles(
        edit, faces=edit.faces[:], angle_face_threshold=JOINED, angle_shape_threshold=JOINED
    )
    made = cast(Mesh, bpy.data.meshes.new(dense.name))
    places = [vertex.co for vertex in edit.verts]
    made.from_pydata(places, [], [[v.index for v in face.verts] for face in edit.faces])
    edit.free()
    return made


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
    larger = 2.0 ** np.round(np.log2(MEAN_EDGE / _mean_edge(mesh, len(mesh.polygons))))
    mesh.transform(Matrix.Scale(larger, 4))
    try:
        bpy.ops.object.quadriflow_remesh(mode="FACES", target_faces=faces, use_preserve_sharp=False)
    except RuntimeError:
        return False
    if not 0 < len(mesh.polygons) <= 10 * faces:
        return False
    mesh.transform(Matrix.Scale(1.0 / larger, 4))
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
