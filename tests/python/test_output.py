# SPDX-License-Identifier: GPL-3.0-or-later
"""The result's control vertices to the last bit, refined topology, types, and polygons."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from surfaces import as_lists, boundary_loops, euler_characteristic, output_faces

NAMES = sorted(meshes.ALL)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("levels", [0, 1, 2, 3])
def test_the_same_surface_refined(name, levels):
    vertices, faces = meshes.ALL[name]()
    lists = as_lists(faces)
    result = df.fair(vertices, faces, levels)
    triangles, quads = result.faces
    assert result.vertices[: len(vertices)].tobytes() == np.ascontiguousarray(vertices).tobytes()
    assert result.report["largest_deviation"] == 0
    assert result.vertices.dtype == np.float64 and np.isfinite(result.vertices).all()
    assert triangles.dtype == quads.dtype == result.triangles.dtype == np.int32
    assert triangles.shape[1] == 3 and quads.shape[1] == 4 and result.triangles.shape[1] == 3
    used = np.unique(np.concatenate([triangles.ravel(), quads.ravel()]))
    assert np.array_equal(used, np.arange(len(result.vertices)))

    # polygons of five and more sides become fans around a centre; of the house a warped quad is cut
    sizes = [len(face) for face in lists]
    fans, kept = sum(n == 3 for n in sizes) + sum(n for n in sizes if n > 4), sizes.count(4)
    if name != "house":
        assert [len(f) for f in result.faces] == [4**levels * fans, 4**levels * kept]
        assert len(result.triangles) == 4**levels * (fans + 2 * kept)
    predicted = df.predicted_size(len(vertices), faces, levels)
    most = 1 if max(sizes) < 5 else 2
    assert len(result.triangles) <= predicted["triangles"] <= most * len(result.triangles)
    assert len(result.vertices) <= predicted["vertices"] <= most * len(result.vertices)

    for refined in (output_faces(result), result.triangles.tolist()):
        assert df.check(result.vertices, refined) == []
        assert euler_characteristic(refined) == euler_characteristic(lists)
        assert boundary_loops(refined) == boundary_loops(lists)
    corners = [set() for _ in faces]  # those of the control mesh in the cells of each polygon
    for cells, polygon in ((triangles, result.triangle_polygon), (quads, result.quad_polygon)):
        for cell, p in zip(cells.tolist(), polygon.tolist(), strict=True):
            corners[p].update(v for v in cell if v < len(vertices))
    assert corners == [set(face) for face in lists]


@pytest.mark.parametrize("offset, scale", [(0.1, 1 / 3), (1e5, 7.7), (-123.456, 1e-4)])
@pytest.mark.parametrize("boundary", ["curve", "linear", "free"])
def test_vertices_are_kept_wherever_the_mesh_lies(offset, scale, boundary):
    """No working frame carries these coordinates there and back without rounding."""
    (vertices, faces), ridge = meshes.roof()
    vertices = vertices * scale + [offset, 2 * offset, -offset]
    result = df.fair(vertices, faces, 2, boundary=boundary, crease_edges=ridge)
    assert result.vertices[: len(vertices)].tobytes() == vertices.tobytes()


def test_isolated_vertices_are_kept_with_a_warning():
    vertices, faces = meshes.icosahedron()
    lonely = np.array([[5.0, 0.1, 0.3], [-7, 0, 1 / 3]])
    result = df.fair(np.concatenate([lonely[:1], vertices, lonely[1:]]), faces + 1, 2)
    assert np.array_equal(result.vertices[[0, 13]], lonely)
    (warning,) = result.report["warnings"]
    assert (warning["code"], list(warning["elements"])) == ("ISOLATED_VERTICES", [0, 13])
    assert not np.isin([0, 13], result.triangles).any()
