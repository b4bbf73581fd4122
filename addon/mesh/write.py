# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a result of the core as a Blender mesh, in bulk."""

from typing import Any, TypeAlias

import numpy as np

from ..blender import Mesh, Object
from ..settings import Settings
from ..transfer.attributes import AttributeTransfer
from ..transfer.seams import mark_pairs
from .layers import (
    Refined,
    SurfaceData,
    fill_layer,
    layer_values,
    make_layer,
    values_of_layer,
    write_data,
)
from .marks import BOUNDARY, NORMAL

# (e, 2) vertices; the edge that leaves each corner
Edges: TypeAlias = tuple[np.ndarray, np.ndarray]

PAD_SIZES = "fair_pad_size"
# an attribute on faces: faces of a surface near scans without points
NO_POINTS = "fair_no_points"
# attributes on points: the faults of a surface, by kind
FAULTS = {"crossing": "fair_crosses_itself", "far": "fair_far_from_mesh", "folded": "fair_folded"}


def write_surface(
    target: Object,
    result: Any,
    sharp_pairs: np.ndarray,
    data: SurfaceData,
    transfer: AttributeTransfer,
    settings: Settings,
    edges: Edges | None = None,
    operators: bool = True,
) -> None:
    """Gives the mesh of `target`, in Object Mode, the geometry of `result` and the data of the control mesh, except
    shape keys. The mesh, its materials and the object's modifiers stay; data on the old geometry are lost.

    `operators`: not within handlers.
    """
    if target.data.shape_keys is not None:
        target.shape_key_clear()
    target.data.clear_geometry()
    target.vertex_groups.clear()
    fill_mesh(target.data, result, sharp_pairs, edges)
    carrier = Refined(transfer, target.data)
    write_data(target, data, carrier, attributes_left_out(settings), operators)
    _write_pad_sizes(target.data, result, transfer)


def fill_mesh(mesh: Mesh, result: Any, sharp_pairs: np.ndarray, edges: Edges | None = None) -> None:
    """Gives an empty `mesh` the triangles of `result`, then its quads; the control vertices come first. The refined
    edges `sharp_pairs` (k, 2) are marked sharp, so that smooth shading stops there. `edges`: of `edge_table`, None:
    found here.
    """
    write_faces(mesh, result.vertices, *result.faces)
    if edges is not None:
        _write_edges(mesh, *edges)
    mesh.update(calc_edges=edges is None)
    if len(sharp_pairs):
        _mark_sharp(mesh, sharp_pairs)


def attributes_left_out(settings: Settings) -> tuple[str, ...]:
    """Names of the attributes that a surface does not take over from its source."""
    made = (PAD_SIZES, NO_POINTS, *FAULTS.values(), BOUNDARY.name, NORMAL.name)
    return (*made, "sharp_face") if settings.shade_smooth else made


def _write_pad_sizes(mesh: Mesh, result: Any, transfer: AttributeTransfer) -> None:
    """Writes the sizes of the pads that hold its control vertices, if any is reduced."""
    pads = result.report["pads"]
    if pads["gone"]:
        widths = transfer.point(np.asarray(pads["widths"], np.float32))
        fill_layer(make_layer(mesh, PAD_SIZES, "FLOAT", "POINT"), widths.ravel())


def faces_without_points(mesh: Mesh) -> np.ndarray:
    """(f,) bool: faces that a fit has marked with `NO_POINTS`."""
    values = values_of_layer(mesh, NO_POINTS, "BOOLEAN", "FACE")
    return np.zeros(len(mesh.polygons), bool) if values is None else values


def has_faces_of(mesh: Mesh, result: Any) -> bool:
    """Whether the faces of `mesh` are those of `result`: nobody has replaced the mesh."""
    triangles, quads = result.faces
    return (
        len(mesh.vertices) == len(result.vertices)
        and len(mesh.polygons) == len(triangles) + len(quads)
        and mesh.shape_keys is None
    )


def write_positions(mesh: Mesh, vertices: np.ndarray) -> None:
    """Moves the points of `mesh` to `vertices` (N, 3), in single precision, as one block."""
    mesh.attributes["position"].data.foreach_set("vector", vertices.astype(np.float32).ravel())
    mesh.update()


def write_faces(mesh: Mesh, vertices: np.ndarray, triangles: np.ndarray, quads: np.ndarray) -> None:
    """Gives an empty `mesh` `vertices` (n, 3), `triangles` (t, 3) and then `quads` (q, 4)."""
    corners = np.concatenate([triangles.ravel(), quads.ravel()]).astype(np.int32, copy=False)
    starts = np.concatenate(
        [3 * np.arange(len(triangles)), triangles.size + 4 * np.arange(len(quads))]
    ).astype(np.int32)
    mesh.vertices.add(len(vertices))
    mesh.loops.add(len(corners))
    mesh.polygons.add(len(starts))
    mesh.attributes["position"].data.foreach_set("vector", vertices.astype(np.float32).ravel())
    mesh.attributes[".corner_vert"].data.foreach_set("value", corners)
    mesh.polygons.foreach_set("loop_start", starts)


def _write_edges(mesh: Mesh, edges: np.ndarray, corner_edges: np.ndarray) -> None:
    mesh.edges.add(len(edges))
    mesh.attributes[".edge_verts"].data.foreach_set("value", edges.ravel())
    mesh.attributes[".corner_edge"].data.foreach_set("value", corner_edges)


def _mark_sharp(mesh: Mesh, pairs: np.ndarray) -> None:
    sharp = make_layer(mesh, "sharp_edge", "BOOLEAN", "EDGE")
    fill_layer(sharp, mark_pairs(layer_values(mesh.attributes[".edge_verts"]), pairs))
