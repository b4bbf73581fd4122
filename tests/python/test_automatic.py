# SPDX-License-Identifier: GPL-3.0-or-later
"""interpolation="auto": kept flats for bevelled bodies, limit positions for cages with hollows, and find_flats()."""

import control_meshes
import discrete_fairing as df
import flat_parts
import numpy as np
import pytest
from bevelled_boxes import bevelled_box
from discrete_fairing.control_mesh import ControlMesh
from discrete_fairing.flats import SPACING
from thin_walls import cup


@pytest.mark.parametrize("fans", ["middles", "rims"])
def test_a_chamfered_cylinder_stays_one(fans):
    """Through its vertices it bulges by a tenth and more."""
    result = df.fair(*flat_parts.chamfered_cylinder(32, fans), interpolation="auto")
    radius = np.linalg.norm(result.vertices[:, :2], axis=1).max() / 12.5
    assert abs(radius - 1) < 0.02 and result.report["converged"]


def prongs(degrees, gap=0.0, rows=3):
    """(vertices, quads): two prongs on a block; the walls of their slit, `gap` apart below, open by `degrees`."""
    z = np.arange(-1, rows) * 0.6
    inner = np.maximum(z, 0.0) * np.tan(np.radians(degrees / 2)) + gap / 2
    columns = (0 * z - 1, -inner, rows), (inner, 0 * z + 1, rows), (-inner, inner, 1)
    index, faces = {}, []

    def at(x, y, height):
        return index.setdefault((round(x, 9), y, round(height, 9)), len(index))

    for left, right, top in columns if gap else columns[:2]:
        ring = [(left, -0.5), (right, -0.5), (right, 0.5), (left, 0.5)]
        for k in range(top):
            low, high = z[k], z[k + 1]
            for (a, y), (b, after) in zip(ring, ring[1:] + ring[:1]):
                if k or y == after or abs(a[0]) == 1.0:  # the block has no wall in its middle
                    lower = at(a[k], y, low), at(b[k], after, low)
                    faces.append([*lower, at(b[k + 1], after, high), at(a[k + 1], y, high)])
        faces.append([at(x[top], y, z[top]) for x, y in ring])
        faces.append([at(x[0], y, z[0]) for x, y in ring[::-1]])
    return np.array(list(index)), faces


@pytest.mark.parametrize(
    "degrees, gap, slit", [(20, 0, True), (40, 0, False), (0, 0.15, True), (0, 0.5, False)]
)
def test_walls_of_a_slit_do_not_cross(degrees, gap, slit):
    points, faces = prongs(degrees, gap)
    right = np.array([points[face, 0].mean() > 1e-9 for face in faces])

    def beyond(interpolation):
        found = df.fair(points, faces, 3, interpolation=interpolation)
        return found, -found.vertices[found.faces[1][right[found.quad_polygon]], 0].min()

    auto, across = beyond("auto")
    expected, _ = beyond("limit" if slit else "exact")
    assert np.array_equal(auto.vertices, expected.vertices) and across < 1e-6
    assert not slit or beyond("exact")[1] > 0.01


CAGES = {"cup": cup()[:2], "bevelled box": bevelled_box((4, 3, 1), 0.05)}


@pytest.mark.parametrize(
    "name, settings", [("cup", {}), ("bevelled box", {"energy": "total_curvature"})]
)
def test_cages_pass_where_subdivision_surface_does(name, settings):
    auto, limit = (
        df.fair(*CAGES[name], 1, interpolation=i, **settings).vertices for i in ("auto", "limit")
    )
    assert np.array_equal(auto, limit)


def flats_kept(name, levels=1, **settings):
    """The surface with the flats of the cage `name` kept."""
    kept = {"flat_faces": df.find_flats(*CAGES[name]), "metric_exponent": SPACING}
    return df.fair(*CAGES[name], levels, **kept, **settings).vertices


def test_bevelled_bodies_keep_their_flats():
    auto = df.fair(*CAGES["bevelled box"], 1, interpolation="auto").vertices
    assert np.array_equal(auto, flats_kept("bevelled box"))


def test_concave_faces_are_not_subdivided():
    """With curved energies too: subdivision folds a face where one of its sides cannot be seen from its middle."""
    outline = np.array([(0, 0), (6, 0), (6, 2), (2, 2), (2, 5), (0, 5)], float)
    middle = outline.mean(axis=0)
    rings = [(0.9, 0.0), (1.0, 0.3), (1.0, 2.7), (0.9, 3.0)]
    points = [(*(middle + s * (p - middle)), z) for s, z in rings for p in outline]
    bands = [
        [6 * r + k, 6 * r + (k + 1) % 6, 6 * r + 6 + (k + 1) % 6, 6 * r + 6 + k]
        for r in range(3)
        for k in range(6)
    ]
    faces = [[5, 4, 3, 2, 1, 0], *bands, list(range(18, 24))]
    auto, exact = (
        df.fair(points, faces, 1, "total_curvature", interpolation=i).vertices
        for i in ("auto", "exact")
    )
    assert np.array_equal(auto, exact)


@pytest.mark.parametrize(
    "mesh",
    [control_meshes.cube, control_meshes.torus, control_meshes.grid, control_meshes.creature],
)
def test_other_meshes_pass_through_their_vertices(mesh):
    points, faces = mesh()
    assert np.array_equal(
        df.fair(points, faces, 1, interpolation="auto").vertices[: len(points)], points
    )


@pytest.mark.parametrize(
    "settings",
    [{"tolerance": 0.1}, {"flat_faces": [0]}, {"region": [0, 1, 2, 3]}, {"crease_angle": 0.6}],
)
def test_settings_that_limit_positions_exclude_decide(settings):
    auto = df.fair(*CAGES["bevelled box"], 1, interpolation="auto", **settings)
    assert np.array_equal(auto.vertices, df.fair(*CAGES["bevelled box"], 1, **settings).vertices)


def test_sharp_rims_are_no_rims():
    points, faces = CAGES["bevelled box"]
    creases = {"crease_edges": ControlMesh.of(points, *_flat(faces)).edges}
    auto = df.fair(points, faces, 1, interpolation="auto", **creases).vertices
    assert np.array_equal(auto[: len(points)], points)


def test_a_half_is_taken_as_the_whole():
    points, faces = CAGES["bevelled box"]
    faces = [face for face in faces if (points[face, 0] > 0).any()]
    half = np.where(points[:, :1] < 0, points * [0.0, 1.0, 1.0], points)
    auto, limit = (
        df.fair(half, faces, 1, "total_curvature", symmetry_plane="x", interpolation=i).vertices
        for i in ("auto", "limit")
    )
    assert np.array_equal(auto, limit)
    kept = df.fair(half, faces, 1, symmetry_plane="x", interpolation="auto").vertices
    assert np.array_equal(kept[: len(half)], half)


def test_pieces_agree_with_the_whole():
    points, faces = CAGES["cup"]
    whole = df.fair(points, faces, 1, interpolation="auto").vertices
    parts = [piece.fair() for piece in df.pieces(points, faces, 1, count=2, interpolation="auto")]
    assert np.allclose(df.join(parts).vertices, whole, atol=1e-2)


@pytest.mark.parametrize("energy", ["thin_plate", "total_curvature"])
def test_a_solver_keeps_the_choice(energy):
    points, faces = CAGES["bevelled box"]
    solver = df.Solver(points, faces, 1, energy, interpolation="auto")
    chosen = df.fair(points, faces, 1, energy, interpolation="auto").vertices
    assert np.allclose(solver.solve(points).vertices, chosen, atol=1e-6)


def test_defects_are_named_as_without_it():
    points, faces = control_meshes.cube()
    for broken in ([*np.asarray(faces).tolist(), [0, 1, 99]], [[0, 1]]):
        with pytest.raises(df.FairingError) as plain:
            df.fair(points, broken, 1)
        with pytest.raises(df.FairingError) as auto:
            df.fair(points, broken, 1, interpolation="auto")
        assert auto.value.code == plain.value.code


def test_flats_of_a_bevelled_box_are_its_sides():
    points, faces = CAGES["bevelled box"]
    assert df.find_flats(points, faces)[:6].tolist() == [0, 1, 2, 3, 4, 5]
    assert len(df.find_flats(points, faces)) == 18  # and the twelve strips between them
    assert not len(df.find_flats(*control_meshes.icosahedron()))
    assert not len(df.find_flats(np.empty((0, 3)), []))


def test_strips_may_be_cut_across():
    """A side of a strip is all of its border to one other part."""
    points, faces = CAGES["bevelled box"]
    right = [f for f in faces if (points[f, 0] > 0).any()]
    half = np.where(points[:, :1] < 0, points * [0.0, 1.0, 1.0], points)
    mirrored = [[v + len(points) for v in f[::-1]] for f in right]
    welded, origin = np.unique(
        np.concatenate([half, half * [-1.0, 1.0, 1.0]]) + 0.0, axis=0, return_inverse=True
    )
    cut = [origin.ravel()[f].tolist() for f in [*right, *mirrored]]
    # four sides and four strips are two faces each
    assert len(df.find_flats(welded, cut)) == 18 + 4 + 4


def test_flats_may_end_at_creases_as_those_that_auto_keeps():
    points, faces = CAGES["bevelled box"]
    half = np.where(points[:, :1] < 0, points * [0.0, 1.0, 1.0], points)
    edges = ControlMesh.of(half, *_flat(faces)).edges
    rim = edges[(half[edges, 0] == 0).all(axis=1)]
    plain, kept = (df.find_flats(half, faces, crease_edges=rim[:k]) for k in (0, len(rim)))
    assert set(plain) < set(kept)
    auto = df.fair(half, faces, 1, interpolation="auto", crease_edges=rim)
    given = df.fair(half, faces, 1, flat_faces=kept, metric_exponent=SPACING, crease_edges=rim)
    assert np.array_equal(auto.vertices, given.vertices)


def _flat(faces):
    return np.concatenate(faces).astype(np.int64), np.cumsum([0, *map(len, faces)])


def test_degenerate_faces_have_finite_folds():
    points = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (0, 0, 0), (0, 0, 0)], float)
    mesh = ControlMesh.of(points, *_flat([(0, 1, 2), (0, 1, 3), (0, 4, 5), (2, 1, 3)]))
    assert np.isfinite(mesh.fold_angles[0]).all()


def test_a_face_without_corners_has_no_area_and_moves_no_other():
    points, faces = control_meshes.cube()
    faces = np.asarray(faces).tolist()
    for k in (0, 3, len(faces)):
        mesh = ControlMesh.of(points, *_flat([*faces[:k], [], *faces[k:]]))
        areas = mesh.face_areas
        assert areas[k] == 0 and np.allclose(np.delete(areas, k), areas.max())
