# SPDX-License-Identifier: GPL-3.0-or-later
"""Half a mesh with a symmetry plane: the surface is half of the whole mesh's, and meets its image."""

import discrete_fairing as df
import numpy as np
import pytest
from half_hulls import COUNT, hull, whole

TIGHT = {"relative_residual": 1e-11, "step_tolerance": 1e-10}
ENDS = [0, 4 * (COUNT - 1)]  # of the keel


@pytest.mark.parametrize("energy", ["thin_plate", "total_curvature"])
def test_the_half_is_that_of_the_whole(energy):
    points, faces = hull()
    half = df.fair(points, faces, 3, energy, symmetry_plane="y", **TIGHT)
    both = df.fair(*whole(points, faces), 3, energy, **TIGHT)
    own = both.quad_polygon < len(faces)
    assert np.array_equal(half.quad_polygon, both.quad_polygon[own])
    there = both.vertices[both.faces[1][own]]
    assert np.allclose(half.vertices[half.faces[1]], there, atol=1e-7)
    assert np.array_equal(half.vertices[: len(points)], points)
    assert len(half.vertices) == half.faces[1].max() + 1


def test_the_seam_lies_in_the_plane_and_its_normals_too():
    points, faces = hull()
    found = df.fair(points, faces, 4, symmetry_plane="y")
    alone = df.fair(points, faces, 4, corner_vertices=ENDS)

    def seam_angles(result):
        quads = result.faces[1]
        at = np.isclose(result.vertices[:, 1], 0.0, atol=1e-12)
        rows = quads[at[quads].sum(axis=1) == 2]
        a, b, c, d = (result.vertices[rows[:, i]] for i in range(4))
        normals = np.cross(c - a, d - b)
        return np.degrees(np.abs(normals[:, 1] / np.linalg.norm(normals, axis=1)))

    keel = np.unique(np.concatenate([[i, i + 4] for i in range(0, 4 * (COUNT - 1), 4)]))
    assert (found.vertices[keel, 1] == 0).all()
    in_plane = found.vertices[:, 1] == 0
    assert in_plane.sum() == (COUNT - 1) * 16 + 1, "exactly"
    assert seam_angles(found).max() < 0.5 * seam_angles(alone).max(), "tangent across the plane"


def test_settings_by_vertex_edge_and_face_are_mirrored():
    points, faces = hull()
    tolerance = np.linspace(0, 0.05, len(points))
    crease = [[9, 13], [13, 17]]
    options = {"levels": 2, "interpolation": "approximate", "corner_vertices": [10]}
    half = df.fair(
        points,
        faces,
        tolerance=tolerance,
        crease_edges=crease,
        region=np.arange(12),
        symmetry_plane="y",
        **options,
    )
    both_points, both_faces = whole(points, faces)
    image = {tuple(p): i for i, p in enumerate(both_points.tolist())}
    other = [image[tuple(p)] for p in (points * [1, -1, 1]).tolist()]
    both_tolerance = np.zeros(len(both_points))
    both_tolerance[other] = tolerance
    both_tolerance[: len(points)] = tolerance
    options["corner_vertices"] = [10, other[10]]
    both = df.fair(
        both_points,
        both_faces,
        tolerance=both_tolerance,
        crease_edges=crease + [[other[a], other[b]] for a, b in crease],
        region=[*range(12), *range(len(faces), len(faces) + 12)],
        **options,
    )
    own = both.quad_polygon < len(faces)
    there = both.vertices[both.faces[1][own]]
    assert np.allclose(half.vertices[half.faces[1]], there, atol=1e-12)
    assert sorted(map(sorted, half.crease_edges.tolist())) == crease
    assert len(half.report["pads"]["widths"]) == len(points)


def test_shapes_and_mended_meshes_are_halved_too():
    points, faces = hull()
    taller = points * [1, 1, 2]
    twice = np.concatenate([faces, faces[:1]])
    found = df.fair(points, twice, 2, repair="mend", shapes=[taller], symmetry_plane="y", **TIGHT)
    clean = df.fair(points, faces, 2, shapes=[taller], symmetry_plane="y", **TIGHT)
    assert np.allclose(found.shapes[0], clean.shapes[0]) and len(found.shapes[0]) == len(
        found.vertices
    )
    assert np.array_equal(found.shapes[0][: len(points)], taller)
    mended = found.mended
    assert len(mended.offsets) == len(faces) + 1 and mended.offsets[-1] == len(mended.corners)
    assert len(mended.vertex_origin) == len(points)
    assert len(mended.corner_origin) == len(mended.corners)
    assert mended.quad_face.max() < len(faces)


def test_the_solver_has_it():
    points, faces = hull()
    solver = df.Solver(points, faces, 2, symmetry_plane="y")
    first = df.fair(points, faces, 2, symmetry_plane="y")
    assert np.array_equal(solver.solve().vertices, first.vertices)
    moved = points + [0, 0, 0.1] * np.sin(points[:, :1])
    expected = df.fair(moved, faces, 2, symmetry_plane="y").vertices
    solver.rebase(moved)
    assert np.allclose(solver.solve(moved).vertices, expected, atol=1e-4)
    assert solver.control_vertices == len(points)


@pytest.mark.parametrize("plane", ["x", "w", "", 1, True])
def test_refusals(plane):
    points, faces = hull()
    with pytest.raises(df.FairingError) as caught:
        df.fair(points, faces, 1, symmetry_plane=plane)
    assert caught.value.code == "BAD_OPTION" and "symmetry_plane" in str(caught.value)


def test_a_keel_that_is_creased_stays_sharp():
    points, faces = hull()
    keel = [[i, i + 4] for i in range(0, 4 * (COUNT - 1), 4)]
    sharp = df.fair(points, faces, 3, crease_edges=keel, symmetry_plane="y", **TIGHT)
    assert sorted(map(sorted, sharp.crease_edges.tolist())) == keel
    alone = df.fair(points, faces, 3, corner_vertices=ENDS, **TIGHT)
    assert np.allclose(sharp.vertices, alone.vertices, atol=1e-7), "as its own border"
