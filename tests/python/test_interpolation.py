# SPDX-License-Identifier: GPL-3.0-or-later
"""Control vertices come back to the last bit; shapes, types and counts are what is documented."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from surfaces import as_lists

NAMES = sorted(meshes.ALL)


def split_counts(faces) -> tuple[int, int]:
    """Control triangles and quads after polygons of five and more sides became fans around a
    centre."""
    sizes = [len(face) for face in as_lists(faces)]
    return sum(n == 3 for n in sizes) + sum(n for n in sizes if n > 4), sizes.count(4)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("levels", [0, 1, 3])
def test_control_vertices_are_kept_to_the_last_bit(name, levels):
    vertices, faces = meshes.ALL[name]()
    result = df.fair(vertices, faces, levels)
    assert result.vertices[: len(vertices)].tobytes() == np.ascontiguousarray(vertices).tobytes()
    assert result.report["largest_deviation"] == 0


@pytest.mark.parametrize("offset, scale", [(0.1, 1 / 3), (1e5, 7.7), (-123.456, 1e-4)])
@pytest.mark.parametrize("boundary", ["curve", "linear", "free"])
def test_kept_wherever_the_mesh_lies(offset, scale, boundary):
    """Coordinates that no working frame can carry there and back without rounding."""
    (vertices, faces), ridge = meshes.roof()
    vertices = vertices * scale + [offset, 2 * offset, -offset]
    result = df.fair(vertices, faces, 2, boundary=boundary, crease_edges=ridge)
    assert result.vertices[: len(vertices)].tobytes() == vertices.tobytes()


@pytest.mark.parametrize("name", NAMES)
def test_shapes_and_types(name):
    vertices, faces = meshes.ALL[name]()
    result = df.fair(vertices, faces, 2)
    triangles, quads = result.faces
    assert result.vertices.dtype == np.float64 and result.vertices.shape == (
        len(result.vertices),
        3,
    )
    assert triangles.dtype == quads.dtype == result.triangles.dtype == np.int32
    assert triangles.shape[1] == 3 and quads.shape[1] == 4 and result.triangles.shape[1] == 3
    assert np.isfinite(result.vertices).all()


@pytest.mark.parametrize("name", sorted(set(NAMES) - {"house"}))
@pytest.mark.parametrize("levels", [0, 1, 2, 4])
def test_each_level_quadruples_the_faces(name, levels):
    vertices, faces = meshes.ALL[name]()
    result = df.fair(vertices, faces, levels, relative_residual=1e-2)
    triangles, quads = split_counts(faces)
    assert [len(f) for f in result.faces] == [4**levels * triangles, 4**levels * quads]
    assert len(result.triangles) == 4**levels * (triangles + 2 * quads)


def test_cells_of_a_polygon_come_in_fours_whatever_its_split():
    vertices, faces = meshes.mixed_house()
    once, twice = (df.fair(vertices, faces, levels) for levels in (1, 2))
    for polygon in range(len(faces)):
        cells = [
            (r.triangle_polygon == polygon).sum() + (r.quad_polygon == polygon).sum()
            for r in (once, twice)
        ]
        assert cells[0] > 0 and cells[1] == 4 * cells[0]


@pytest.mark.parametrize("name", sorted(meshes.CLOSED))
def test_predicted_size_is_what_comes(name):
    """To the last one where all faces are triangles; at most double where polygons are split."""
    vertices, faces = meshes.CLOSED[name]()
    result = df.fair(vertices, faces, 2)
    predicted = df.predicted_size(len(vertices), faces, 2)
    most = 1 if all(len(face) < 5 for face in as_lists(faces)) else 2
    assert len(result.triangles) <= predicted["triangles"] <= most * len(result.triangles)
    assert len(result.vertices) <= predicted["vertices"] <= most * len(result.vertices)
