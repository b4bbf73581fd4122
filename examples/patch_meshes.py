# SPDX-License-Identifier: GPL-3.0-or-later
"""Spline patches as objects: each tessellated by itself, with the normals that it has in CAD."""

import bpy
import numpy as np
from discrete_fairing import spline_knots

STEPS = 24  # of a patch, each way
TINTS = ((0.50, 0.405, 0.325), (0.20, 0.36, 0.44), (0.44, 0.20, 0.15), (0.30, 0.38, 0.20))


def basis(spans, at):
    """(len(at), spans + 3) values of the cubic basis functions, and the same of their derivatives."""
    knots = spline_knots(spans)
    last = np.clip((at * spans).astype(int), 0, spans - 1) + 3
    values = (np.arange(spans + 6) == last[:, None]).astype(float)
    for degree in (1, 2, 3):
        lower = values
        widths = knots[degree:] - knots[: len(knots) - degree]
        shares = np.divide(1.0, widths, out=np.zeros_like(widths), where=widths > 0)
        rising = (at[:, None] - knots[: len(widths) - 1]) * shares[:-1]
        falling = (knots[degree + 1 :] - at[:, None]) * shares[1:]
        values = rising * lower[:, :-1] + falling * lower[:, 1:]
    slopes = degree * (lower[:, :-1] * shares[:-1] - lower[:, 1:] * shares[1:])
    return values, slopes


def tessellated(patches):
    """A mesh object of all patches, coloured so that neighbours differ."""
    t = np.linspace(0, 1, STEPS + 1)
    points, normals = [], []
    for p in range(len(patches)):
        (u, du), (v, dv) = (basis(spans, t) for spans in patches.patch_spans[p].tolist())
        net = patches.net(p)
        along_u, along_v = (np.einsum("ai,bj,ijk->abk", *way, net) for way in ((du, v), (u, dv)))
        normal = np.cross(along_u, along_v)
        points.append(np.einsum("ai,bj,ijk->abk", u, v, net).reshape(-1, 3))
        normals.append((normal / np.linalg.norm(normal, axis=2)[..., None]).reshape(-1, 3))
    i, j = np.divmod(np.arange(STEPS**2), STEPS)
    corner = i * (STEPS + 1) + j
    quads = np.stack([corner, corner + STEPS + 1, corner + STEPS + 2, corner + 1], axis=1)
    first = (STEPS + 1) ** 2 * np.arange(len(patches))
    mesh = bpy.data.meshes.new("Patches")
    faces = (first[:, None, None] + quads).reshape(-1, 4)
    mesh.from_pydata(np.concatenate(points).tolist(), [], faces.tolist())
    for tint in TINTS:
        mesh.materials.append(_matte(tint))
    mesh.polygons.foreach_set("material_index", np.repeat(_tints(patches), STEPS**2))
    mesh.polygons.foreach_set("use_smooth", np.ones(len(faces), bool))
    mesh.normals_split_custom_set_from_vertices(np.concatenate(normals).tolist())
    return _linked(bpy.data.objects.new("Patches", mesh))


def edges(patches, kinds, colour, thickness):
    """The edges of these kinds as thin round bars."""
    curve = bpy.data.curves.new("Edges", "CURVE")
    curve.dimensions = "3D"
    curve.bevel_depth = thickness / 2
    t = np.linspace(0, 1, STEPS + 1)
    for e in np.flatnonzero(np.isin(patches.edge_kind, kinds)).tolist():
        points = basis(int(patches.edge_spans[e]), t)[0] @ patches.edge(e)
        spline = curve.splines.new("POLY")
        spline.points.add(STEPS)
        spline.points.foreach_set("co", np.column_stack([points, np.ones(len(points))]).ravel())
    curve.materials.append(_matte(colour))
    return _linked(bpy.data.objects.new("Edges", curve))


def _tints(patches):
    """(P,) numbers of colours, chosen greedily: patches at an edge differ where four colours suffice."""
    beside = [set() for _ in range(len(patches))]
    owner = np.repeat(np.arange(len(patches)), np.diff(patches.loop_offsets))
    for e in range(len(patches.edge_spans)):
        at = owner[patches.loop_edges == e].tolist()
        for p in at:
            beside[p].update(at)
    found = np.full(len(patches), -1, np.int32)
    for p, others in enumerate(beside):
        taken = {int(found[other]) for other in others}
        free = [k for k in range(len(TINTS)) if k not in taken]
        found[p] = free[0] if free else p % len(TINTS)
    return found


def _matte(colour):
    material = bpy.data.materials.new("Patch")
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    shader.inputs["Roughness"].default_value = 0.5
    return material


def _linked(made):
    bpy.context.scene.collection.objects.link(made)
    return made
