# SPDX-License-Identifier: GPL-3.0-or-later
"""Spline patches of fair surfaces: accuracy, seams, topology, refusals."""

import sys
from pathlib import Path

import control_meshes
import discrete_fairing as df
import example_meshes
import flat_parts
import folding_meshes
import half_hulls
import numpy as np
import pytest
import thin_walls
from discrete_fairing.cad import fitting
from lattices import lattice_faces
from refusing import refusal
from spline_measures import basis, evaluate, radii, volume

sys.path.append(str(Path(__file__).resolve().parents[2] / "benchmarks"))

step_distances = pytest.importorskip("step_distances")
CURVED = {"energy": "total_curvature"}
SMOOTH = {
    "cube": (control_meshes.cube(), CURVED),
    "octahedron": (control_meshes.octahedron(), CURVED),
    "torus": (control_meshes.torus(), CURVED),
    "open triangles": (control_meshes.wavy_patch(), {"levels": 6}),
    "creases": (control_meshes.drum()[0], {"levels": 6, "crease_edges": control_meshes.drum()[1]}),
    "triangles and quads": (control_meshes.mixed_house(), {"levels": 6, "tolerance": 1e-3}),
}


@pytest.fixture(scope="module")
def fitted():
    found = {}

    def of(name):
        if name not in found:
            mesh, options = SMOOTH[name]
            found[name] = df.fit_patches(*mesh, **options)
        return found[name]

    return of


@pytest.mark.parametrize("name", ["cube", "octahedron"])
def test_points_on_a_sphere_give_its_patches(fitted, name):
    patches = fitted(name)
    radius = np.linalg.norm(SMOOTH[name][0][0][0])
    assert np.abs(radii(patches) / radius - 1).max() < 1e-4
    assert volume(patches) == pytest.approx(4 / 3 * np.pi * radius**3, rel=1e-4)
    assert patches.patch_spans.prod(axis=1).mean() <= 16


def test_a_sharper_tolerance_is_met():
    mesh = control_meshes.cube()
    patches = df.fit_patches(*mesh, tolerance=1e-5, **CURVED)
    assert np.abs(radii(patches) / 3**0.5 - 1).max() < 1e-5
    assert patches.levels > 5


@pytest.mark.parametrize(
    ("mesh", "levels"),
    [
        (control_meshes.cube(), 5),
        (control_meshes.cut_quads(control_meshes.cube()), 7),
        (control_meshes.octahedron(), 7),
        (control_meshes.mixed_house(), 7),
    ],
    ids=["cube", "cube of triangles", "octahedron", "triangles and quads"],
)
def test_patches_follow_the_poles_of_curvature_at_vertices(mesh, levels):
    """A thin plate has a pole of curvature at each control vertex."""
    patches = df.fit_patches(*mesh, levels=levels)
    assert patches.levels == levels and not len(patches.unmet_by_fit)
    assert patches.largest_residual <= 1e-4 * patches.size


@pytest.mark.parametrize("valence", range(3, 13))
def test_patches_meet_at_vertices_of_any_valence(valence):
    patches = df.fit_patches(*star(valence), levels=6, force=True)
    assert not len(patches.unmet_by_fit) and not len(patches.unresolved)
    assert patches.largest_angle <= patches.normal_tolerance
    assert patches.largest_residual <= 1e-4 * patches.size


def star(valence):
    """So many triangles around the top of a dome, with quads around them."""
    turn = 2 * np.pi * np.arange(valence) / valence
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    flat = np.concatenate([[(0, 0)], ring, 2 * ring])
    points = np.column_stack([flat, -0.15 * (flat**2).sum(axis=1)])
    ends = [(1 + k, 1 + (k + 1) % valence) for k in range(valence)]
    faces = [[0, a, b] for a, b in ends]
    return points, faces + [[a, a + valence, b + valence, b] for a, b in ends]


def test_what_is_said_is_what_others_find():
    """The report's distances are those from flat triangles at 13 x 13 points of each patch."""
    (points, faces), creases = example_meshes.hull()
    patches = df.fit_patches(points, faces, levels=5, crease_edges=creases, force=True)
    t = np.linspace(0, 1, 13)
    at = [evaluate(patches, p, t, t)[0].reshape(-1, 3) for p in range(len(patches))]
    result = patches.result
    found = step_distances.distances(
        np.concatenate(at), result.vertices, result.triangles.astype(np.int64)
    ).reshape(len(patches), -1)
    assert found.max() <= 1.2 * patches.largest_residual
    missed = found.max(axis=1) > 1.2 * patches.tolerance * patches.size
    assert not (missed & ~patches.covering(patches.unmet_by_fit)).any()


@pytest.mark.parametrize("levels", [4, 5])
def test_what_a_given_level_is_off_by_is_measured_too(levels):
    by_level = df.fit_patches(*control_meshes.cube(), levels=levels, **CURVED)
    assert by_level.refinement_error.min() > 0
    assert (len(by_level.unmet) == 0) == (by_level.largest_off <= 1e-4 * by_level.size)
    assert len(by_level.unmet) == (6 if levels == 4 else 0)


def test_half_a_hull_is_refused():
    """Its deck has a corner that turns by 39 degrees at each level and tolerance."""
    kept = {"symmetry_plane": "y", "corner_angle": np.radians(60)}
    for tolerance in (1e-4, 1e-5):
        error = refusal(df.fit_patches, *half_hulls.hull(), tolerance=tolerance, **kept)
        assert (error.code, error.kind) == ("UNRESOLVED", "face")
        assert sorted(error.elements) == [0, 15]


def box(width, height):
    """Six quads around a box of length 1."""
    corners = np.array(list(np.ndindex(2, 2, 2)), float) * (width, height, 1.0)
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return corners, sides


@pytest.fixture
def levels_asked(monkeypatch):
    """The levels of the surfaces that are asked for."""
    fair, asked = fitting.fair, []
    monkeypatch.setattr(
        fitting, "fair", lambda *mesh, **options: asked.append(mesh[2]) or fair(*mesh, **options)
    )
    return asked


@pytest.mark.parametrize("levels", [None, 5])
@pytest.mark.parametrize("options", [{}, CURVED])
def test_a_fold_is_refused_on_the_coarsest_surface(levels_asked, options, levels):
    """The next one takes up to ten times as long, and the fold stays in it."""
    error = refusal(df.fit_patches, *box(1, 1e-3), levels=levels, **options)
    assert (error.code, error.elements) == ("UNRESOLVED", [0, 1, 4, 5])
    assert levels_asked == [3]


def test_a_fold_that_finer_levels_take_away_is_not_refused(levels_asked):
    """This one turns by 162, 133 and 32 degrees on levels 2 to 4."""
    assert not len(df.fit_patches(*box(0.01, 0.01)).unresolved)
    assert levels_asked == [3, 4, 5, 6]


def test_a_tip_lower_than_the_tolerance_is_no_fold():
    """Around a vertex of three triangles ever smaller cells turn by 105 degrees at any level."""
    points, faces = control_meshes.tetrahedron()
    exact = df.fit_patches(points, faces, levels=7, force=True)
    assert exact.unresolved.tolist() == [0, 1, 2, 3]
    patches = df.fit_patches(points, faces, levels=7, tolerance=5e-4)
    assert not len(patches.unmet)
    assert np.degrees(patches.turned.max()) < 10


def test_edges_may_leave_the_lattices_lines_within_the_surface():
    """These lines wind, and curves along them would need many spans."""
    patches = df.fit_patches(*control_meshes.random_hull(), levels=5, **CURVED)
    assert not len(patches.unmet)
    assert np.abs(radii(patches) - 1).max() < 1e-4 * patches.size
    assert patches.patch_spans.prod(axis=1).mean() <= 16


def test_edges_end_at_vertices_and_patches_cover_all_polygons(fitted):
    patches = fitted("triangles and quads")
    ends = np.stack([patches.edge_offsets[:-1], patches.edge_offsets[1:] - 1], axis=1)
    assert np.allclose(patches.edge_points[ends], patches.vertices[patches.edge_vertices])
    assert len(patches.vertices) - len(patches.edge_spans) + len(patches) == 2
    assert set(patches.patch_polygon) == set(range(len(SMOOTH["triangles and quads"][0][1])))


@pytest.mark.parametrize("name", SMOOTH)
def test_tolerances_are_met_and_said(fitted, name):
    patches = fitted(name)
    assert patches.residual.max() <= patches.tolerance * patches.size
    angles = np.degrees(patches.edge_angles[np.isfinite(patches.edge_angles)])
    assert angles.max() <= 0.1
    assert np.quantile(angles, 0.999) <= 0.06
    assert not len(patches.unresolved)
    worst = np.nan_to_num(patches.edge_angles).max()
    assert patches.largest_angle == worst


def test_creases_are_edges(fitted):
    patches = fitted("creases")
    creases = patches.edge_kind == 1
    pairs = patches.result.crease_edges
    assert creases.sum() >= len(pairs) > 0
    assert patches.edge_error[creases].max() < patches.tolerance * patches.size / 2


@pytest.mark.parametrize("energy", ["thin_plate", "total_curvature"])
@pytest.mark.parametrize("height", [0.0, 0.2, 0.7])
def test_straight_borders_may_meet_at_corners(height, energy):
    """Where they leave the surface's plane it has a kink, the tip of a cone; nothing folds."""
    mesh = control_meshes.wavy_patch(height=height)
    patches = df.fit_patches(*mesh, levels=5, boundary="linear", energy=energy)
    assert not len(patches.unresolved)
    assert patches.largest_residual <= 1e-3 * patches.size
    assert np.degrees(patches.turned.max()) < 10
    straight = patches.edge_kind == 2
    assert patches.edge_error[straight].max() <= 1e-12 * patches.size
    # angles are told everywhere but at the tips
    told = np.isfinite(patches.edge_angles[patches.edge_kind == 0])
    assert told.all() == (height == 0.0) and told[:, 8].all()
    if height == 0.0:
        assert not len(patches.unmet)


@pytest.mark.parametrize("height", [0.02, 0.03])
def test_slight_kinks_are_met_and_their_angles_told(height):
    """A straight border that bends out of the surface bends it too, and no patch leaves it."""
    points, faces = control_meshes.grid()
    points[:, 2] = height * (points[:, 0] - 2) ** 2
    patches = df.fit_patches(points, faces, levels=5, boundary="linear")
    assert patches.largest_residual <= 1e-4 * patches.size
    assert patches.largest_angle == pytest.approx(2 * height, rel=0.02)
    assert np.nanmax(patches.edge_angles[:, 3:-3]) < 2 * patches.normal_tolerance
    assert not len(patches.unmet)  # the kinks are the surface's own


def test_creases_may_have_corners_all_along():
    """Curves that end in the kinks there run on; once some turned back, and their patches folded."""
    mesh, creases = example_meshes.hull()
    patches = df.fit_patches(*mesh, levels=5, crease_edges=creases, corner_angle=0.1)
    assert np.degrees(patches.turned.max()) < 20
    assert patches.largest_residual <= 1e-3 * patches.size
    inside = np.linspace(0, 1, 65)[1:-1]
    for e in range(len(patches.edge_spans)):
        points = patches.edge(e)
        speed = basis(patches.edge_spans[e], inside)[1] @ points @ (points[-1] - points[0])
        assert speed.min() > 0


def block_over_an_l():
    """A block with edges off the lines of its flat faces, so that finer levels are tried for it."""
    flat, _ = folding_meshes.corner()
    walls = [[i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i] for i in range(6)]
    return np.vstack([flat, flat + [0, 0, 1]]), [list(range(6))[::-1], list(range(6, 12)), *walls]


SHARP = {"crease_angle": np.radians(30), "corner_angle": np.radians(20)}


def test_a_block_with_a_flat_concave_face_has_patches_at_a_fine_level():
    patches = df.fit_patches(*block_over_an_l(), levels=6, **SHARP)
    assert not len(patches.unresolved) and patches.shell_closed.all()
    # its creases are straight already
    assert "STRAIGHT_CURVE" not in [w["code"] for w in patches.result.report["warnings"]]


def test_a_thin_tray_misses_few_faces():
    """Fitted at level 5, 16 of 94 faces had too few spans, and missed by 4.6e-4."""
    tray = thin_walls.phone_case()
    patches = df.fit_patches(*tray[:2], crease_angle=np.radians(30), corner_angle=np.radians(45))
    assert len(patches.unmet_by_surface) and patches.levels == 6
    assert not len(patches.unresolved) and patches.largest_angle < patches.normal_tolerance
    assert len(patches.unmet_by_fit) <= 8
    assert patches.largest_residual < 1.2e-4 * patches.size


def test_faces_much_longer_than_wide_do_not_fold():
    """Normals along their sides once outweighed all that keeps the rows of a narrow patch apart."""
    patches = df.fit_patches(*box(0.1, 0.02), levels=5, force=True)
    assert np.degrees(patches.turned).max() < 25  # 180; the surface turns by 22.6 from cell to cell
    assert patches.largest_residual < 1e-3


def wall_with_boss(angle, height, cell, rings):
    """Part of a cylinder about z with a boss on one cell, and the four vertices at its open end. Each ring: how long
    it is along x, y and z, as a share of the cell, and how far it is moved."""
    wall = np.array(
        [(40 * np.cos(a), 40 * np.sin(a), z) for z in height for a in np.radians(angle)]
    )
    n = len(angle)
    low = [n * i + j for i, j in np.ndindex(len(height) - 1, n - 1)]
    cells = [[k, k + 1, k + n + 1, k + n] for k in low]
    end = cells.pop(cell)
    middle = wall[end].mean(axis=0)
    points = [wall, *(middle + share * (wall[end] - middle) + move for share, move in rings)]
    for k in range(len(wall), len(wall) + 4 * len(rings), 4):
        start, end = end, list(range(k, k + 4))
        cells += [[start[t], start[t - 3], end[t - 3], end[t]] for t in range(4)]
    return np.concatenate(points), cells, end


def test_a_tip_between_two_creases_is_no_fold():
    """At the foot of a boss two creases make a corner of 270 degrees: it was refused once."""
    rings = [(0.7, (0, 0, 0)), (0.7, (7, 0, 0))]
    points, faces, top = wall_with_boss((-45, -15, 15, 45), (-24, 6, 30, 54), 4, rings)
    patches = df.fit_patches(points, [*faces, top], levels=5, crease_angle=np.radians(30))
    assert not len(patches.unresolved)
    assert set(patches.unmet) >= {8, 9, 10, 11}  # round the tips off, and are named
    assert patches.largest_residual < 5e-4 * patches.size


@pytest.mark.parametrize("margin", [0.4, 0.1])
def test_a_flat_sheet_with_lines_beside_its_straight_borders_is_one_patch(margin):
    """It was nine patches, of which six and three missed, the sheet folded in its plane."""
    x, y = (
        np.array([-8, margin - 8, 8 - margin, 8]),
        np.array([-0.9, margin - 0.9, 0.9 - margin, 0.9]),
    )
    points = [(a, b, 0) for a in x for b in y]
    patches = df.fit_patches(points, lattice_faces(4, 4), boundary="linear")
    assert len(patches.patch_spans) == 1
    assert patches.largest_off < 1e-9


def test_flats_between_smooth_rims_are_planes_and_walls_between_them_are_met():
    """Curvature jumps beside flats and straight walls; normals there were off by up to 2.3 degrees."""
    points, faces = flat_parts.chamfered_cylinder(16, "")
    patches = df.fit_patches(points, faces, interpolation="auto", levels=4)
    assert len(patches.written) == 36
    caps = np.unique(patches.patch_plane[patches.patch_plane >= 0])
    assert [len(faces[cap]) for cap in caps] == [16, 16]
    assert np.degrees(patches.largest_angle) < 0.1
    assert patches.largest_residual < 1e-4 * patches.size


def test_rows_of_quads_are_one_patch_whose_curvature_does_not_jump():
    points, faces = control_meshes.grid()
    points[:, 2] = 0.2 * np.sin(points[:, 0]) * np.cos(points[:, 1])
    whole = df.fit_patches(points, faces, levels=5)
    assert len(whole) == 1 and whole.polygons(0).tolist() == list(range(16))
    left = points[faces].mean(axis=1)[:, 0] < 1
    parts = df.fit_patches(points, faces, levels=5, groups=left.astype(int))
    assert [set(left[parts.polygons(p)].tolist()) for p in range(2)] in (
        [{True}, {False}],
        [{False}, {True}],
    )
    assert parts.covering([0]).sum() == 1
    between = np.isfinite(parts.edge_jumps).any(axis=1)
    assert between.sum() == 1 and (parts.edge_kind[between] == 0).all()
    assert 0 < np.nanmax(parts.edge_jumps) * parts.size < 0.2


def test_patches_end_where_others_need_it():
    """From a vertex of three quads lines run on through the regular faces beside it; half a hull is one patch."""
    assert len(df.fit_patches(*half_hulls.hull(), levels=5)) == 1
    points, faces = control_meshes.cube()
    fine = df.fair(points, faces, 1, energy="total_curvature")
    patches = df.fit_patches(fine.vertices, fine.faces[1], levels=4, **CURVED)
    assert len(patches) == 6 and patches.shell_closed.all()
    assert sorted(np.diff(patches.patch_face_offsets)) == [4] * 6


BOX = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
OPEN = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4)]


def corner_normals(patches):
    """(P, 3) at u = v = 0."""
    nets = [patches.net(p) for p in range(len(patches))]
    return np.array([np.cross(net[1, 0] - net[0, 0], net[0, 1] - net[0, 0]) for net in nets])


def loops_start_at_the_corner(patches):
    for p in range(len(patches)):
        at = patches.net(p)[0, 0]
        for edge, forward in patches.loop(p):
            ends = patches.edge(edge)[[0, -1] if forward else [-1, 0]]
            assert np.allclose(ends[0], at, atol=1e-12)
            at = ends[1]
        assert np.allclose(at, patches.net(p)[0, 0], atol=1e-12)


def test_a_mirrored_open_shell_still_looks_outward():
    patches = df.fit_patches(BOX, OPEN, levels=5)
    before = patches.patch_points.copy()
    mirrored = patches.transformed(np.diag([-1.0, 1, 1, 1]))
    loops_start_at_the_corner(mirrored)
    wanted = corner_normals(patches) * (-1, 1, 1)
    assert np.allclose(corner_normals(mirrored), wanted, atol=1e-12)
    assert (patches.patch_points == before).all()
