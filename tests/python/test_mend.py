# SPDX-License-Identifier: GPL-3.0-or-later
"""repair="mend", act by act: what is done and said, and which faces and corners remain."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
import tight
from refusing import refusal
from surfaces import as_lists, half_edges

POINTS, FACES = meshes.icosahedron()


def mend(vertices, faces, levels=1, **options):
    """The result, and (code, elements) of each repair."""
    result = tight.fair(vertices, faces, levels, repair="mend", **options)
    return result, [(r["code"], list(r["elements"])) for r in result.report["repairs"]]


def mended_faces(result):
    """The faces that were faired, as lists."""
    m = result.mended
    return [m.corners[a:b].tolist() for a, b in zip(m.offsets[:-1], m.offsets[1:])]


def assert_same_surface(result, other):
    assert result.vertices.tobytes() == other.vertices.tobytes()
    assert all(np.array_equal(a, b) for a, b in zip(result.faces, other.faces))


def open_edges(faces):
    """Sides that no other side opposes."""
    sides = half_edges(faces)
    return sorted(set(sides) - {(b, a) for a, b in sides})


@pytest.mark.parametrize("name", meshes.ALL)
def test_a_clean_mesh_is_faired_as_ever(name):
    vertices, faces = meshes.ALL[name]()
    result, acts = mend(vertices, faces)
    assert acts == [] and result.mended is None
    assert_same_surface(result, tight.fair(vertices, faces, 1))


def test_duplicate_faces_are_dropped_and_the_first_is_kept():
    faces = [*as_lists(FACES[:7]), as_lists(FACES)[3][::-1], *as_lists(FACES[7:])]
    faces.append(faces[3][1:] + faces[3][:1])
    result, acts = mend(POINTS, faces)
    assert acts == [("DUPLICATE_FACE", [7, 21])]
    assert_same_surface(result, tight.fair(POINTS, FACES, 1))
    ids = [f for f in range(22) if f not in (7, 21)]
    assert result.mended.face_origin.tolist() == ids
    assert result.triangle_polygon.tolist() == np.repeat(ids, 4).tolist()
    (act,) = result.report["repairs"]
    assert act["kind"] == "face" and act["message"].startswith("2 faces (7, 21) had the same")


def test_a_doubled_corner_goes():
    faces = as_lists(FACES)
    a, b, c = faces[6]
    faces[6] = [a, b, b, c, a]
    faces += [[3, 3, 5], [2, 2, 2]]
    result, acts = mend(POINTS, faces)
    assert acts == [("REPEATED_VERTEX", [6, 20, 21])]
    assert_same_surface(result, tight.fair(POINTS, FACES, 1))
    assert result.mended.corner_origin[18:21, 0].tolist() == [18, 19, 21]
    assert not result.mended.corner_share.any()


def test_a_face_that_comes_by_a_vertex_again_is_cut_there():
    points = [[0, 0, 0.5], [1, 1, 0], [1, -1, 0], [-1, -1, 0], [-1, 1, 0]]
    faces = [[1, 0, 4, 3, 0, 2], [0, 1, 4], [0, 3, 2]]
    result, acts = mend(np.array(points), faces)
    assert acts == [("REPEATED_VERTEX", [0])]
    assert mended_faces(result) == [[0, 4, 3], [1, 0, 2], [0, 1, 4], [0, 3, 2]]
    assert result.mended.face_origin.tolist() == [0, 0, 1, 2]
    assert result.mended.corner_origin[:6, 0].tolist() == [1, 2, 3, 0, 1, 5]
    assert len(open_edges(mended_faces(result))) == 4


def test_faces_with_fewer_than_three_corners_go():
    faces = [[0, 1], *as_lists(FACES), [4], []]
    result, acts = mend(POINTS, faces)
    assert acts == [("BAD_SHAPE", [0, 21, 22])]
    assert_same_surface(result, tight.fair(POINTS, FACES, 1))
    assert result.triangle_polygon.min() == 1


def test_a_side_without_length_is_merged_and_both_rows_go_together():
    """Vertex 12 lies on vertex 3 and stands between it and its neighbours in two faces."""
    points = np.concatenate([POINTS, POINTS[3:4]])
    faces = as_lists(FACES)
    with_3 = [f for f, face in enumerate(faces) if 3 in face]
    sides = {tuple(sorted(set(faces[f]) - {3})) for f in with_3}
    assert len(sides) == 5
    moved = with_3[0]
    faces[moved] = [12 if v == 3 else v for v in faces[moved]]
    a, b = (v for v in faces[moved] if v != 12)
    faces += [[3, 12, a], [3, b, 12]]  # no area: they close the slit
    result, acts = mend(points, faces, 2)
    assert acts == [("COINCIDENT_VERTICES", [12]), ("DEGENERATE_FACE", [20, 21])]
    plain = tight.fair(points, FACES, 2)
    assert_same_surface(result, plain)
    assert result.mended.vertex_origin.tolist() == [*range(12), 3]
    assert result.report["warnings"] == [], "vertex 12 is not left over"


def cap_mesh():
    """Two big triangles over the edge 0-1 of a tent; below the edge two small ones whose common
    vertex 4 lies on it, and the triangle 0, 4, 1 without area that joins them to what is above."""
    points = np.array([[0.0, 0, 0], [4, 0, 0], [2, 3, 1], [2, -3, 1], [1, 0, 0]])
    return points, [[0, 1, 2], [0, 4, 1], [4, 0, 3], [1, 4, 3]]


def test_a_cap_goes_and_its_vertex_comes_into_the_neighbour():
    points, faces = cap_mesh()
    result, acts = mend(points, faces, 0)
    assert acts == [("DEGENERATE_FACE", [1])]
    assert mended_faces(result) == [[0, 4, 1, 2], [4, 0, 3], [1, 4, 3]]
    assert result.mended.face_origin.tolist() == [0, 2, 3]
    assert open_edges(mended_faces(result)) == sorted([(1, 2), (2, 0), (0, 3), (3, 1)])
    # the new corner is a quarter of the way along side 0-1 of face 0
    assert result.mended.corner_origin[:4].tolist() == [[0, 0], [0, 1], [1, 1], [2, 2]]
    assert result.mended.corner_share[:4].tolist() == [0, 0.25, 0, 0]
    assert set(result.triangle_polygon.tolist()) == {0, 2, 3}


def test_a_needle_loses_its_short_side_and_a_cap_on_a_boundary_goes():
    points, faces = cap_mesh()
    result, acts = mend(points, faces[1:], 0)
    assert acts == [("DEGENERATE_FACE", [0])]
    assert mended_faces(result) == [[4, 0, 3], [1, 4, 3]]
    points[4] = [1e-12, 0, 0]
    result, acts = mend(points, faces, 0)
    assert acts == [("COINCIDENT_VERTICES", [4]), ("DEGENERATE_FACE", [1, 2])]
    assert mended_faces(result) == [[0, 1, 2], [1, 0, 3]]


def test_a_quad_that_crosses_itself_without_area_is_cut():
    points = np.array([[0.0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]])
    result, acts = mend(points, [[0, 1, 2, 3]], 0)
    assert acts == [("DEGENERATE_FACE", [0])]
    assert [len(f) for f in mended_faces(result)] == [3, 3]


def test_faces_look_the_same_way_afterwards():
    faces = FACES.copy()
    faces[[3, 11]] = faces[[3, 11], ::-1]
    faces = np.concatenate([faces[:1], faces])
    result, acts = mend(POINTS, faces)
    assert acts == [("DUPLICATE_FACE", [1]), ("INCONSISTENT_ORIENTATION", [4, 12])]
    assert list(result.report["flipped_faces"]) == [4, 12]
    assert result.vertices.tobytes() == tight.fair(POINTS, FACES, 1).vertices.tobytes()
    # the fewest faces turn in each part; of two the first stays
    faces = np.concatenate([FACES[:, ::-1], FACES + 12])
    faces[[3, 25]] = faces[[3, 25], ::-1]
    twins = np.concatenate([POINTS, POINTS + 5])
    assert mend(twins, faces)[0].report["flipped_faces"] == [3, 25]
    points, quads = meshes.grid(2, 1)
    assert mend(points, [quads[0], quads[1][::-1]])[0].report["flipped_faces"] == [1]


def cut_apart():
    """The icosahedron with corners of its own for every face, as in an STL file."""
    return POINTS[FACES.reshape(-1)], np.arange(60).reshape(-1, 3)


def test_coincident_vertices_are_welded_on_request_only():
    points, faces = cut_apart()
    loose, acts = mend(points, faces)
    assert acts == [] and loose.mended is None
    result, acts = mend(points, faces, weld=0)
    ((code, merged),) = acts
    first = {}
    lead = [first.setdefault(v, k) for k, v in enumerate(FACES.reshape(-1).tolist())]
    assert code == "COINCIDENT_VERTICES" and merged == [k for k in range(60) if lead[k] != k]
    assert result.mended.vertex_origin.tolist() == lead
    assert open_edges(mended_faces(result)) == []
    ids = np.array(sorted(first.values()))
    welded = tight.fair(
        POINTS[FACES.reshape(-1)[ids]], np.searchsorted(ids, np.array(lead).reshape(-1, 3)), 1
    )
    assert np.allclose(result.vertices[ids], welded.vertices[:12], rtol=0, atol=1e-12)
    assert np.allclose(result.vertices[60:], welded.vertices[12:], rtol=0, atol=1e-12)


def test_welding_within_a_distance():
    points, faces = cut_apart()
    moved = points + np.random.default_rng(1).uniform(-1e-4, 1e-4, points.shape)
    assert open_edges(mended_faces(mend(moved, faces, weld=1e-3)[0])) == []
    assert mend(moved, faces, weld=1e-9)[1] == []
    # no vertex moves farther than that, however close they stand
    line = np.array([[k * 0.4, y, 0] for k in range(20) for y in (0.0, 5.0)])
    strip = [[2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1] for k in range(19)]
    result, _ = mend(line, strip, 0, weld=0.5)
    origin = result.mended.vertex_origin
    assert np.linalg.norm(line - line[origin], axis=1).max() <= 0.5
    assert len(np.unique(origin)) == 20


def test_what_no_program_can_mend_is_refused_in_the_input_s_ids():
    lost = POINTS.copy()
    lost[5] = np.nan
    with_unused = np.concatenate([[[np.inf, 0, 0]], lost])
    for vertices, faces, code, elements in [
        ([], [], "EMPTY_MESH", []),
        (POINTS, [], "NO_FACES", []),
        (with_unused, FACES + 1, "NON_FINITE", [6]),
        (POINTS, [[0, 1, 12]], "INDEX_OUT_OF_RANGE", [0]),
        (POINTS[[0, 0, 1]], [[0, 1, 2], [2, 2, 1]], "NO_FACES", []),
    ]:
        error = refusal(df.fair, vertices, faces, 1, repair="mend")
        assert (error.code, list(error.elements)) == (code, elements)


def test_a_vertex_without_position_and_face_does_no_harm():
    points = np.concatenate([POINTS, [[np.nan, 0, 0], [0, 1e120, 0], [0, -np.inf, 0]]])
    result, acts = mend(points, FACES, shapes=[points * 2])
    assert acts == [("NON_FINITE", [12, 14]), ("NON_FINITE", [13])], "far off is another sentence"
    assert np.isfinite(result.vertices).all() and np.isfinite(result.shapes[0]).all()
    assert np.array_equal(result.vertices[:12], POINTS)
    assert result.report["warnings"] == []


@pytest.mark.parametrize("absent", [-1, 12, 2**31, 2**32 + 1])
def test_faces_that_name_absent_vertices_are_dropped(absent):
    """A hole is left, as if they had never been there; creases and normals of their vertices stay."""
    faces = FACES.astype(np.int64)
    faces[[3, 7], [1, 2]] = absent
    (defect,) = (d for d in df.check(POINTS, faces) if d.severity == "error")
    assert (defect.code, defect.elements, defect.repairable) == ("INDEX_OUT_OF_RANGE", [3, 7], True)
    result, acts = mend(POINTS, faces)
    assert acts == [("INDEX_OUT_OF_RANGE", [3, 7])]
    kept = np.delete(FACES, [3, 7], axis=0)
    assert np.array_equal(result.vertices, tight.fair(POINTS, kept, 1).vertices)
    assert set(result.triangle_polygon) == set(range(len(FACES))) - {3, 7}
