# SPDX-License-Identifier: GPL-3.0-or-later
"""A measured patch in place: its vertices are data, noise is removed, and the rest stays."""

import bpy
import numpy as np
import pytest
from scenes import edit, positions, to_object_mode

NOISE = 0.004  # rms


def move(scan, points):
    scan.data.vertices.foreach_set("co", points.astype(np.float32).ravel())
    scan.data.update()


def corners(scan):
    return np.array([face.vertices[:] for face in scan.data.polygons])


def inner(faces, chosen, count):
    """(n,) bool: the vertices with all faces chosen."""
    return np.bincount(faces[chosen].ravel(), minlength=count) == np.bincount(
        faces.ravel(), minlength=count
    )


def sphere():
    """A unit sphere of 20,480 faces with noise along the normals inside a patch of 2,188."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6)
    scan = bpy.context.object
    points = positions(scan.data).astype(float)
    points /= np.linalg.norm(points, axis=1)[:, None]
    faces = corners(scan)
    middle = points[faces].mean(axis=1)
    chosen = np.zeros(len(faces), bool)
    chosen[np.argsort(-middle[:, 2] + 0.01 * middle[:, 0])[:2188]] = True
    inside = inner(faces, chosen, len(points))
    noise = np.random.default_rng(2).standard_normal((len(points), 1)) * NOISE
    move(scan, points * (1 + noise * inside[:, None]))
    edit(scan, "FACE", np.flatnonzero(chosen))
    return scan, inside


def fair_measured(scan, **settings):
    before = positions(scan.data)
    assert bpy.ops.object.fairing_in_place(vertices="MEASURED", **settings) == {"FINISHED"}
    to_object_mode()
    return before, positions(scan.data)


def off(points):
    return np.sqrt(((np.linalg.norm(points, axis=1) - 1) ** 2).mean())


@pytest.mark.parametrize("joint", ["TANGENT", "CURVATURE"])
def test_a_noisy_patch_of_a_sphere_comes_back(joint):
    scan, inside = sphere()
    before, after = fair_measured(scan, joint=joint)
    assert off(after[inside]) < 0.125 * NOISE
    np.testing.assert_allclose(after[~inside], before[~inside], atol=1e-7)


def test_a_noise_that_is_given_is_what_comes_off():
    scan, inside = sphere()
    before, after = fair_measured(scan, noise=0.001)
    taken = np.sqrt(((after - before)[inside] ** 2).sum(axis=1).mean())
    assert taken == pytest.approx(0.001, rel=0.2)


def ridge(sharp):
    """A roof with noise off its ridge; the faces inside are selected."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=40, y_subdivisions=40)
    scan = bpy.context.object
    points = positions(scan.data).astype(float)
    points[:, 2] = -0.6 * np.abs(points[:, 0])
    true = points.copy()
    on = np.abs(points[:, 0]) < 1e-6
    assert on.any()
    points[~on, 2] += 0.004 * np.random.default_rng(3).standard_normal((~on).sum())
    move(scan, points)
    ends = np.array([edge.vertices[:] for edge in scan.data.edges])
    if sharp:
        scan.data.attributes.new("sharp_edge", "BOOLEAN", "EDGE").data.foreach_set(
            "value", on[ends].all(axis=1)
        )
    middle = true[corners(scan)].mean(axis=1)
    edit(scan, "FACE", np.flatnonzero((np.abs(middle[:, :2]) < 0.8).all(axis=1)))
    near = (np.abs(points[:, 1]) < 0.7) & (np.abs(points[:, 0]) < 0.07)
    return scan, true, near


def test_an_edge_marked_sharp_stays_one():
    heights = {}
    for sharp in (True, False):
        scan, true, near = ridge(sharp)
        _, after = fair_measured(scan)
        heights[sharp] = np.abs(after - true)[near, 2].max()
        bpy.data.objects.remove(scan)
    assert heights[True] < 0.006 < heights[False]
