# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets that meet: each is faired as if it were alone, and the result is one welded mesh."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from sheet_meshes import alone, book, bow_ties, bulkhead, hourglass
from surfaces import euler_characteristic, output_faces
from tight import fair

SPINE = np.arange(5)  # of a book with four rows


def corners_of(result, faces):
    """The surface over these control faces, corner by corner."""
    triangles, quads = result.faces
    return np.concatenate(
        [
            result.vertices[triangles[np.isin(result.triangle_polygon, faces)]].reshape(-1, 3),
            result.vertices[quads[np.isin(result.quad_polygon, faces)]].reshape(-1, 3),
        ]
    )


def ids_of(result, faces):
    """The vertices of the surface over these control faces."""
    triangles, quads = result.faces
    return np.union1d(
        triangles[np.isin(result.triangle_polygon, faces)],
        quads[np.isin(result.quad_polygon, faces)],
    )


def assert_welded(result, vertices, faces):
    """Every vertex is used, no two are one point, and the topology is the control mesh's."""
    fine = output_faces(result)
    assert np.array_equal(np.unique(np.concatenate(fine)), np.arange(len(result.vertices)))
    assert len(np.unique(result.vertices, axis=0)) == len(result.vertices)
    assert euler_characteristic(fine) == euler_characteristic(np.asarray(faces).tolist())
    assert np.array_equal(result.vertices[: len(vertices)], vertices)


# on pads loads are found to so much
@pytest.mark.parametrize(
    "triangles, options, most",
    [(False, {"pad_size": 0.0}, 1e-12), (True, {"pad_size": 0.0}, 1e-12), (False, {}, 1e-6)],
)
def test_each_page_of_a_book_is_the_page_alone(triangles, options, most):
    vertices, faces, size = book(4, triangles=triangles)
    to_the_end = {"levels": 3, "relative_residual": 1e-13 if options else 1e-12, **options}
    whole = df.fair(vertices, faces, **to_the_end)
    assert whole.report["converged"]
    assert_welded(whole, vertices, faces)
    for page in range(4):
        own = np.arange(size) + page * size
        mesh = alone(vertices, faces[own])
        single = df.fair(*mesh, corner_vertices=SPINE[[0, -1]], **to_the_end)
        difference = corners_of(whole, own) - corners_of(single, np.arange(size))
        assert np.abs(difference).max() <= most


@pytest.mark.parametrize("boundary", ["curve", "linear", "free"])
def test_pages_share_the_spine_and_the_spine_is_a_curve(boundary):
    vertices, faces, size = book(3)
    result = fair(vertices, faces, 3, boundary=boundary)
    shared = ids_of(result, np.arange(size))
    for page in (1, 2):
        shared = np.intersect1d(shared, ids_of(result, np.arange(size) + page * size))
    assert len(shared) == 4 * 8 + 1 and np.isin(SPINE, shared).all()
    # a page alone has the same curve
    single = fair(*alone(vertices, faces[:size]), 3, corner_vertices=[0, 4])
    points = {tuple(p) for p in single.vertices.tolist()}
    assert all(tuple(p) in points for p in result.vertices[shared].tolist())
    assert sorted(map(sorted, result.crease_edges.tolist())) == [[k, k + 1] for k in range(4)]


def test_sheets_are_counted_and_told():
    vertices, faces, _ = book(3)
    result = fair(vertices, faces, 1)
    assert result.report["sheets"] == {
        "count": 3,
        "nonmanifold_edges": 4,
        "nonmanifold_vertices": 0,
        "one_sided": 0,
    }
    (warning,) = result.report["warnings"]
    assert warning["code"] == "NONMANIFOLD_EDGE" and len(warning["elements"]) == 8
    touching = fair(*hourglass(), 1)
    assert touching.report["sheets"]["nonmanifold_vertices"] == 1
    assert [w["code"] for w in touching.report["warnings"]] == ["NONMANIFOLD_VERTEX"]
    assert fair(*meshes.cube(), 1).report["sheets"] == {
        "count": 1,
        "nonmanifold_edges": 0,
        "nonmanifold_vertices": 0,
        "one_sided": 0,
    }


def test_a_box_with_a_wall():
    (vertices, faces), wall = bulkhead()
    result = fair(vertices, faces, 3)
    assert_welded(result, vertices, faces)
    assert result.report["sheets"]["count"] == 3
    rim = np.intersect1d(ids_of(result, [wall]), ids_of(result, np.arange(wall)))
    assert len(rim) == 4 * 8
    # its rim is a round curve, and the wall is flat in it
    assert np.abs(result.vertices[ids_of(result, [wall]), 0] - 1).max() <= 1e-7
    middle = np.array([1, 0.5, 0.5])
    radii = np.linalg.norm(result.vertices[rim] - middle, axis=1)  # as of a spline through four
    assert radii.min() > 0.97 * 0.5**0.5 and radii.max() < 1.0001 * 0.5**0.5


@pytest.mark.parametrize("mesh", [hourglass, bow_ties])
def test_sheets_that_touch_know_nothing_of_each_other(mesh):
    vertices, faces = mesh()
    half = len(faces) // 2
    result = fair(vertices, faces, 3)
    assert_welded(result, vertices, faces)
    for own in (np.arange(half), np.arange(half, 2 * half)):
        single = fair(*alone(vertices, faces[own]), 3)
        difference = corners_of(result, own) - corners_of(single, np.arange(half))
        assert np.abs(difference).max() <= 1e-12


@pytest.mark.parametrize("energy", ["total_curvature", "minimum_variation"])
@pytest.mark.parametrize("pad_size", [0.0, 1.0])
def test_other_energies(energy, pad_size):
    vertices, faces = hourglass()
    result = df.fair(vertices, faces, 2, energy=energy, pad_size=pad_size, measure=True)
    assert result.report["converged"]
    assert_welded(result, vertices, faces)
    # inscribed in a sphere each, and mirrored across z = 0
    lower = result.vertices[ids_of(result, np.arange(8))]
    upper = result.vertices[ids_of(result, np.arange(8, 16))]
    assert np.abs(np.linalg.norm(lower + [0, 0, 1], axis=1) - 1).max() <= 2e-3
    assert np.abs(np.linalg.norm(upper - [0, 0, 1], axis=1) - 1).max() <= 2e-3


@pytest.mark.parametrize("pages", [[0], [0, 1], [0, 1, 2]])
@pytest.mark.parametrize("joint", ["position", "tangent", "curvature"])
def test_regions(pages, joint):
    vertices, faces, size = book(3)
    chosen = np.concatenate([np.arange(size) + page * size for page in pages])
    result = fair(vertices, faces, 2, region=chosen, joint=joint)
    assert_welded(result, vertices, faces)
    if len(pages) == 3:
        assert np.array_equal(result.vertices, fair(vertices, faces, 2).vertices)
        return
    # the other pages are refined linearly, and the spine with them
    flat = np.setdiff1d(np.arange(3 * size), chosen)
    quads = result.faces[1]
    for face in flat:
        cells = quads[result.quad_polygon == face].reshape(4, 4, 4)
        a, b = result.vertices[cells[0, 0, 0]], result.vertices[cells[0, -1, 1]]
        along = result.vertices[cells[0, :, 1]]
        assert np.abs(along - (a + (b - a) * np.arange(1, 5)[:, None] / 4)).max() <= 1e-12


def test_orientation_is_a_sheet_s_own_affair():
    vertices, faces, size = book(3)
    turned = faces.copy()
    turned[:size] = turned[:size, ::-1]
    assert len(df.check(vertices, turned)) == 1
    result = fair(vertices, turned, 2)
    assert (
        np.abs(np.sort(result.vertices, 0) - np.sort(fair(vertices, faces, 2).vertices, 0)).max()
        < 1e-7
    )
    turned[size + 1] = turned[size + 1, ::-1]  # one against its own page
    with pytest.raises(df.FairingError, match="points against"):
        fair(vertices, turned, 2)
    repaired = fair(vertices, turned, 2, repair="mend")
    assert repaired.report["flipped_faces"] == [size + 1]
