# SPDX-License-Identifier: GPL-3.0-or-later
"""Refines a mesh object and writes its data without the operator."""

from types import SimpleNamespace

import bpy
import discrete_fairing
import numpy as np

from addon.mesh.layers import Refined, read_data, write_data
from addon.mesh.read import read_mesh
from addon.mesh.write import fill_mesh
from addon.transfer.attributes import AttributeTransfer

NO_PAIRS = np.empty((0, 2), np.int32)


def refine(source, levels=2, leave_out=(), sharp_pairs=NO_PAIRS, **settings):
    """The refined object `target` of `source`, and all that went into it."""
    arrays, data = read_mesh(source.data), read_data(source, source.data)
    result, transfer = core_run(arrays, levels, **settings)
    target = bpy.data.objects.new("Refined", bpy.data.meshes.new("Refined"))
    fill_mesh(target.data, result, sharp_pairs)
    bpy.context.collection.objects.link(target)
    write_data(target, data, Refined(transfer, target.data), leave_out)
    return SimpleNamespace(
        target=target, mesh=target.data, data=data, arrays=arrays, result=result, transfer=transfer
    )


def core_run(arrays, levels, **settings):
    result = discrete_fairing.fair(
        arrays.positions, (arrays.corners, arrays.offsets), levels, measure=False, **settings
    )
    return result, AttributeTransfer(result, arrays, levels)


def control_arrays(positions, polygons):
    """The arrays that AttributeTransfer needs of a control mesh given by hand."""
    sides = {tuple(sorted(s)) for p in polygons for s in zip(p, (*p[1:], p[0]))}
    return SimpleNamespace(
        positions=np.array(positions, float),
        edges=np.array(sorted(sides), np.int32),
        corners=np.concatenate(polygons).astype(np.int32),
        offsets=np.cumsum([0] + [len(p) for p in polygons]).astype(np.int32),
    )


def values(mesh, name, field="value", width=1, dtype=np.float32):
    """An attribute of `mesh` as an array (size, width), or (size,)."""
    data = mesh.attributes[name].data
    found = np.empty(len(data) * width, dtype)
    data.foreach_get(field, found)
    return found.reshape(len(data), width) if width > 1 else found


def corner_vertices(mesh):
    return values(mesh, ".corner_vert", dtype=np.int32)


def edge_vertices(mesh):
    return values(mesh, ".edge_verts", width=2, dtype=np.int32)
