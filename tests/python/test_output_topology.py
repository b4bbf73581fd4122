# SPDX-License-Identifier: GPL-3.0-or-later
"""The refined surface is the same surface: manifold, oriented, of the same genus, and knows where
each face is from."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
import tight
from surfaces import (
    as_lists,
    assert_oriented_manifold,
    boundary_loops,
    euler_characteristic,
    face_normals,
    output_faces,
)

NAMES = sorted(meshes.ALL)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("levels", [1, 3])
def test_same_topology(name, levels):
    vertices, faces = meshes.ALL[name]()
    result = df.fair(vertices, faces, levels)
    for refined in (output_faces(result), result.triangles.tolist()):
        assert_oriented_manifold(refined, len(result.vertices))
        assert euler_characteristic(refined) == euler_characteristic(as_lists(faces))
        assert boundary_loops(refined) == boundary_loops(as_lists(faces))


@pytest.mark.parametrize("name", NAMES)
def test_every_vertex_is_used(name):
    result = df.fair(*meshes.ALL[name](), 2)
    used = np.unique(np.concatenate([f.reshape(-1) for f in result.faces]))
    assert np.array_equal(used, np.arange(len(result.vertices)))


@pytest.mark.parametrize("name", ["icosahedron", "cube", "dodecahedron", "random_hull"])
def test_outside_stays_outside(name):
    vertices, faces = meshes.ALL[name]()
    result = df.fair(vertices, faces, 2)
    centre = result.vertices[result.triangles].mean(1)
    assert (
        np.einsum("fi,fi->f", face_normals(result.vertices, result.triangles), centre) > 0
    ).all()


@pytest.mark.parametrize("name", NAMES)
def test_faces_know_their_polygon(name):
    """The cells of one polygon hold its corners, and no corner of another."""
    vertices, faces = meshes.ALL[name]()
    result = df.fair(vertices, faces, 2)
    triangles, quads = result.faces
    assert len(result.triangle_polygon) == len(triangles) and len(result.quad_polygon) == len(quads)
    found = [set() for _ in faces]
    for cells, polygon in ((triangles, result.triangle_polygon), (quads, result.quad_polygon)):
        for cell, p in zip(cells.tolist(), polygon.tolist()):
            found[p].update(v for v in cell if v < len(vertices))
    assert found == [set(face) for face in as_lists(faces)]


def test_components_do_not_see_each_other():
    """Two meshes in one call come out as they do alone."""
    one, two = meshes.icosahedron(), meshes.random_hull(15)
    vertices = np.concatenate([one[0], two[0] + 10])
    result = tight.fair(vertices, np.concatenate([one[1], two[1] + 12]), 2, relative_residual=1e-12)
    alone = tight.fair(*one, 2, relative_residual=1e-12)
    own = result.vertices[np.unique(result.triangles[result.triangle_polygon < len(one[1])])]
    assert euler_characteristic(result.triangles.tolist()) == 4
    assert np.abs(np.sort(own, axis=0) - np.sort(alone.vertices, axis=0)).max() < 1e-9


def test_isolated_vertices_are_kept_with_a_warning():
    vertices, faces = meshes.icosahedron()
    lonely = np.array([[5.0, 0.1, 0.3], [-7, 0, 1 / 3]])
    result = df.fair(np.concatenate([lonely[:1], vertices, lonely[1:]]), faces + 1, 2)
    assert np.array_equal(result.vertices[[0, 13]], lonely)
    (warning,) = result.report["warnings"]
    assert (warning["code"], list(warning["elements"])) == ("ISOLATED_VERTICES", [0, 13])
    assert not np.isin([0, 13], result.triangles).any()
