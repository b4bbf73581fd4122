# SPDX-License-Identifier: GPL-3.0-or-later
"""fit(): surfaces near scans whose truth is known."""

import discrete_fairing as df
import numpy as np
import pytest
from control_meshes import cut_quads
from discrete_fairing.cad import finer_fits
from discrete_fairing.level_change import change_between
from lattices import lattice_faces
from refusing import refusal
from scans import (
    angles_to_blob,
    blob_cage,
    blob_scan,
    cube_sphere,
    distance_to_blob,
    normals_of_blob,
    on_blob,
    rms,
    sheet,
    vertex_normals,
)
from surface_measures import turns

NOISE = 0.004  # a thousandth of the blob's size


@pytest.fixture(scope="module")
def cage():
    return blob_cage(6, off=0.02)


@pytest.fixture(scope="module")
def scan():
    return blob_scan(26_000, NOISE)


@pytest.fixture(scope="module")
def fitted(cage, scan):
    return df.fit(*cage, scan)


def errors(fitted: df.Fitted) -> tuple[float, float]:
    """Distance from the truth and degrees between normals, root mean square."""
    return (
        rms(distance_to_blob(fitted.vertices)),
        rms(angles_to_blob(fitted.vertices, fitted.triangles)),
    )


def test_surface_is_nearer_to_the_truth_than_a_third_of_the_noise(cage, scan, fitted):
    distance, angle = errors(fitted)
    faired = df.fair(*cage, levels=2)
    assert distance < NOISE / 3
    assert angle < 0.75
    assert angle < rms(angles_to_blob(faired.vertices, faired.triangles)) / 8


def test_report_says_noise_distances_and_coverage(scan, fitted):
    assert fitted.noise == pytest.approx(NOISE, rel=0.08)
    assert fitted.within[0] == pytest.approx(1.96 * NOISE, rel=0.08)
    assert fitted.distances.shape == (len(scan),)
    sides = np.corrcoef(fitted.distances, distance_to_blob(scan))[0, 1]
    assert sides > 0.9
    assert fitted.faces_of_points.min() >= 0
    assert fitted.coverage.min() > 0.9
    assert len(fitted.too_coarse) == 0 and len(fitted.outliers) == 0


@pytest.mark.parametrize("noise", [0.001, 0.016])
def test_weight_goes_with_the_noise(cage, noise):
    fitted = df.fit(*cage, blob_scan(26_000, noise), levels=3)
    assert errors(fitted)[0] < noise / 3
    assert fitted.noise == pytest.approx(noise, rel=0.25)


def test_no_smaller_weight_is_much_nearer_to_the_truth():
    axes = np.array([1.5, 1, 0.7])
    sphere, quads = cube_sphere(58)
    drawn, cage = cube_sphere(4)
    normal = sphere / axes
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    points = sphere * axes + np.random.default_rng(1).normal(0, 0.006, (len(sphere), 1)) * normal

    def error(found):
        far = np.linalg.norm(found.vertices / axes, axis=1)  # of the ellipsoid: 1
        return rms((far - 1) * far / np.linalg.norm(found.vertices / axes**2, axis=1))

    options = {"triangles": cut_quads((points, quads))[1], "levels": 3}
    fitted = df.fit(drawn * axes, cage, points, **options)
    calmer = [
        df.fit(drawn * axes, cage, points, weight=fitted.weight * share, **options)
        for share in (1 / 2, 1 / 4)
    ]
    assert error(fitted) < 1.08 * min(map(error, calmer))


def test_without_noise_the_surface_converges_by_four_a_level(cage):
    scan = blob_scan(100_000)
    distance = [errors(df.fit(*cage, scan, levels=level))[0] for level in (1, 2, 3)]
    assert distance[0] > 3.5 * distance[1] > 3.5**2 * distance[2]


def test_holes_are_bridged_and_strays_ignored(cage, scan):
    random = np.random.default_rng(5)
    points = scan.copy()
    strays = np.flatnonzero(random.random(len(points)) < 0.05)
    off = random.uniform(-0.1, 0.1, (len(strays), 1))
    points[strays] += off * normals_of_blob(points[strays])
    for centre in blob_scan(3, 0.0, 9):
        kept = np.linalg.norm(points - centre, axis=1) > 0.35
        points, strays = points[kept], np.flatnonzero(np.isin(np.flatnonzero(kept), strays))
    fitted = df.fit(*cage, points)
    distance, angle = errors(fitted)
    assert distance < NOISE / 2 and angle < 1.0
    assert np.abs(distance_to_blob(fitted.vertices)).max() < 0.02
    assert fitted.coverage.min() < 0.5
    assert set(fitted.outliers) <= set(strays.tolist())
    assert len(fitted.outliers) > 0.5 * len(strays)


def test_tolerance_is_kept_by_the_calmest_surface(cage, scan, fitted):
    calm = df.fit(*cage, scan, tolerance=0.012)
    assert 0.01 < calm.within[0] <= 0.012
    assert calm.weight < fitted.weight
    assert not [w for w in calm.report["warnings"] if w["code"] == "TOLERANCE_NOT_KEPT"]


def test_a_cage_beside_the_scan_comes_to_it(scan):
    for vertices, faces in (blob_cage(6, 0.1, 3), (1.2 * blob_cage(6)[0], blob_cage(6)[1])):
        assert errors(df.fit(vertices, faces, scan))[0] < NOISE / 2.5


def test_half_a_scan_leaves_the_other_half_to_the_cage(cage, scan):
    fitted = df.fit(*cage, scan[scan[:, 0] > 0])
    assert np.abs(distance_to_blob(fitted.vertices)).max() < 0.2
    on_scan = fitted.vertices[:, 0] > 0.3
    assert rms(distance_to_blob(fitted.vertices[on_scan])) < NOISE / 2


def test_fixed_vertices_stay(cage, scan):
    fixed = np.zeros(len(cage[0]), bool)
    fixed[[3, 40]] = True
    fitted = df.fit(*cage, scan, fixed=fixed)
    moves = np.linalg.norm(fitted.vertices[: len(fixed)] - cage[0], axis=1)
    assert (moves[fixed] == 0).all() and (moves[~fixed] > 0).all()


def test_unit_and_place_do_not_matter(cage, scan, fitted):
    vertices, faces = cage
    moved = df.fit(1000 * vertices + 5e4, faces, 1000 * scan + 5e4)
    assert moved.weight == pytest.approx(fitted.weight, rel=1e-3)
    assert np.abs((moved.vertices - 5e4) / 1000 - fitted.vertices).max() < 1e-4


def dome(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 0.4 * np.cos(1.2 * x) * np.cos(0.9 * y)


def sheet_scan(height, noise: float = 0.0, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A scan of 101 x 101 points of a sheet, with noise along z: points and triangles."""
    dense = np.linspace(-1, 1, 101)
    points, quads = sheet(dense, dense, height)
    points[:, 2] += np.random.default_rng(seed).normal(0, noise, len(points))
    return cut_quads((points, quads))


@pytest.mark.parametrize("hole", [0.4, 0.6, 0.8])
def test_a_corner_without_points_stays_where_it_was_drawn(hole):
    """Its curves once went to the rim of the hole, and faces turned over."""
    even = np.linspace(-0.97, 0.97, 13)
    vertices, faces = sheet(even, even, dome)
    points, triangles = sheet_scan(dome, NOISE)
    kept = np.linalg.norm(points[:, :2] - 1, axis=1) > hole
    triangles = (np.cumsum(kept) - 1)[triangles[kept[triangles].all(1)]]
    corners = [0, 12, 156, 168]
    fitted = df.fit(vertices, faces, points[kept], triangles=triangles, corner_vertices=corners)
    assert np.linalg.norm(fitted.vertices[168] - vertices[168]) < 0.05
    assert vertex_normals(fitted.vertices, fitted.triangles)[:, 2].min() > 0.5


def test_borders_of_a_flat_cage_come_to_a_bent_scan_far_above():
    """Up to two control edges, so that the surface alone would have a wall at its border."""
    even = np.linspace(-0.95, 0.95, 9)
    vertices, faces = sheet(even, even, lambda x, y: 0 * x)
    points, triangles = sheet_scan(lambda x, y: 0.6 * np.cos(1.5 * x) - 0.1)
    fitted = df.fit(vertices, faces, points, triangles=triangles, corner_vertices=[0, 8, 72, 80])
    x, y, z = fitted.vertices.T
    assert rms(z - 0.6 * np.cos(1.5 * x) + 0.1) < 1e-3 and len(fitted.outliers) == 0
    reach = np.abs(fitted.vertices[: len(vertices), :2]).max(1)[np.abs(vertices).max(1) > 0.94]
    assert np.abs(reach - 1).max() < 1e-3


@pytest.mark.parametrize("seed", range(6))
def test_a_scan_of_ten_points_has_a_surface(seed):
    """The points are so few that often none is held out."""
    vertices, faces = sheet(*2 * [np.linspace(-1, 1, 3)], dome)
    x, y = np.random.default_rng(seed).uniform(-0.9, 0.9, (2, 10))
    fitted = df.fit(vertices, faces, np.stack([x, y, dome(x, y)], 1))
    assert np.isfinite(fitted.vertices).all() and fitted.weight > 0


def roof(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return -0.6 * np.abs(y) + 0.1 * np.cos(2 * x)


@pytest.mark.parametrize("corners", [3, 4])
def test_curves_follow_no_noise_where_edges_are_short(corners):
    """A fine control mesh, whose edges along the crease are from 0.008 to 0.24 long."""
    along = 2 * np.linspace(0, 1, 17) ** 2 - 1
    vertices, faces = sheet(along, np.linspace(-1, 1, 13), roof)
    if corners == 3:
        faces = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    points, triangles = sheet_scan(roof, 4 * NOISE, 1)
    ridge, border = (np.flatnonzero(np.abs(vertices[:, 1] - y) < 1e-9) for y in (0, 1))
    options = {
        "crease_edges": np.stack([ridge[:-1], ridge[1:]], 1),
        "corner_vertices": [0, 12, 208, 220],
    }
    fitted = df.fit(vertices, faces, points, triangles=triangles, levels=3, **options)
    x, y, z = fitted.vertices[ridge].T
    assert np.abs([y, z - roof(x, 0 * x)]).max() < 3 * NOISE
    for curve in (ridge, border):
        assert (np.diff(fitted.vertices[curve, 0]) > 0.8 * np.diff(along)).all()


def test_borders_are_as_exact_as_the_scans_own_under_noise_along_its_normals():
    """A wave of four control edges in the border is kept by a weight that halves waves of five."""
    even = np.linspace(-1, 1, 13)
    (vertices, faces), (points, triangles) = sheet(even, even, dome), sheet_scan(dome, 4 * NOISE)

    def edge(x: np.ndarray) -> np.ndarray:
        return 1 + 0.1 * np.cos(3 * np.pi * x)

    for each in (vertices, points):
        each[:, 1] *= edge(each[:, 0])
    options = {"weight": 0.002, "corner_vertices": [0, 12, 156, 168]}
    fitted = df.fit(vertices, faces, points, triangles=triangles, **options)
    x, y = fitted.vertices[12:168:13, :2].T
    assert rms(y - edge(x)) < 3 * NOISE


def test_normals_tell_the_sides_of_a_thin_wall_apart():
    side = np.linspace(-1, 1, 7)
    grid = np.stack(np.meshgrid(side, side, indexing="ij"), -1).reshape(-1, 2)
    quads = lattice_faces(7, 7)
    thickness = 0.02
    upper = np.column_stack([grid, np.full(len(grid), thickness / 2)])
    lower = np.column_stack([grid, np.full(len(grid), -thickness / 2)])
    # the lower side is near the points of the upper one
    vertices = np.concatenate([upper, lower]) + np.array([0, 0, 0.013])
    faces = np.concatenate([quads, quads[:, ::-1] + len(grid)])
    random = np.random.default_rng(1)
    points = random.uniform(-1, 1, (8000, 3))
    up = np.arange(8000) < 4000
    points[:, 2] = np.where(up, thickness / 2, -thickness / 2)
    normals = np.where(up[:, None], [0, 0, 1.0], [0, 0, -1.0])
    fitted = df.fit(vertices, faces, points, normals=normals, boundary="free")
    height = fitted.vertices[: 2 * len(grid), 2]
    assert np.abs(height[: len(grid)] - thickness / 2).max() < 1e-3
    assert np.abs(height[len(grid) :] + thickness / 2).max() < 1e-3


def test_triangles_give_the_normals(cage, scan, fitted):
    # a triangle a point: three points around it, seen from outside
    sparse = on_blob(scan[:3000])
    normal = normals_of_blob(sparse)
    across = np.cross(normal, [0, 0, 1.0])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    along = np.cross(normal, across)
    corners = np.stack([sparse, sparse + 0.01 * across, sparse + 0.01 * along], 1).reshape(-1, 3)
    triangles = np.arange(len(corners)).reshape(-1, 3)
    assert len(df.fit(*cage, corners, triangles=triangles).outliers) == 0
    assert (
        refusal(df.fit, *cage, corners, triangles=triangles[:, ::-1]).code
        == "INCONSISTENT_ORIENTATION"
    )


def test_half_with_a_symmetry_plane_fits_both_halves(scan):
    vertices, faces = blob_cage(6)
    side = scan[scan[:, 1] > 0]
    symmetric = np.concatenate([side, side * [1, -1, 1]])
    kept = (vertices[:, 1] > -1e-9)[faces].all(1)
    used = np.unique(faces[kept])
    number = np.full(len(vertices), -1)
    number[used] = np.arange(len(used))
    half = vertices[used]
    border = np.isin(used, np.unique(faces[~kept]))
    half[border, 1] = 0.0
    fitted = df.fit(half, number[faces[kept]], symmetric, symmetry_plane="y")
    assert fitted.vertices[:, 1].min() > -1e-9
    assert len(fitted.coverage) == kept.sum() and len(fitted.distances) == len(symmetric)
    patches = df.fit_patches(
        half,
        number[faces[kept]],
        scan={"points": symmetric, "weight": fitted.weight},
        symmetry_plane="y",
        levels=2,
        tolerance=0.01,
        force=True,
    )
    one, other = np.split(patches.scan_distances, 2)
    assert (np.abs(one - other) < 1e-6).mean() > 0.999  # the rest are as near to two faces


def test_patches_near_a_scan_know_how_near_they_are(cage, scan):
    patches = df.fit_patches(*cage, scan={"points": scan}, levels=3, tolerance=1e-3)
    fitted, found = patches.result, patches.scan_distances
    assert patches.shell_closed.all() and isinstance(fitted, df.Fitted)
    # `off` has the distance of patches from the surface and of its triangles from the limit; it is
    # measured at samples, and a few points between them are farther off
    assert np.quantile(np.abs(found - fitted.distances), 0.999) < patches.largest_off
    assert patches.scan_within == pytest.approx(fitted.within, abs=patches.largest_residual)
    assert rms(found - distance_to_blob(scan)) < NOISE / 3
    kept = df.fit_patches(
        *cage, scan={"points": scan, "weight": fitted.weight}, levels=3, tolerance=1e-3
    )
    assert np.abs(kept.vertices - patches.vertices).max() < NOISE / 4
    assert df.fit_patches(*cage, levels=2).scan_distances is None


def test_points_lie_near_the_smooth_surface_and_not_near_flat_faces():
    cage, quads = cube_sphere(3)
    points = cube_sphere(30)[0]
    found = df.fit(0.9 * cage, quads, points, levels=2)
    assert np.abs(np.linalg.norm(found.vertices, axis=1) - 1).max() < 1e-3
    middles = found.vertices[found.faces[1]].mean(1)
    assert np.linalg.norm(middles, axis=1).max() < 1 - 2e-3  # flat faces are inside


@pytest.mark.parametrize("has_crease", [False, True])
@pytest.mark.parametrize("cut", [lambda mesh: mesh, cut_quads])
def test_patches_are_those_of_the_fit_itself(cage, scan, cut, has_crease):
    mesh = cut(cage)
    creases = {"crease_edges": [cage[1][0][:2], cage[1][0][1:3]]} if has_crease else {}
    near = {"points": scan, "weight": 0.5}
    fitted = df.fit(*mesh, **near, **creases)
    finer = df.fit_patches(*mesh, scan=near, levels=4, tolerance=1e-3, force=True, **creases).result
    assert (finer.vertices[: len(fitted.vertices)] == fitted.vertices).all()
    assert change_between(fitted, finer, 4, 2).max() < 1e-12


def test_finer_fits_of_concave_cells(monkeypatch):
    """They are cut into triangles on the way; the result has quads all the same."""
    mesh = cube_sphere(2)
    fitted = df.fair(*mesh, 1)
    few = len(fitted.triangles)
    a, b, c, d = fitted.faces[1][0]
    fitted.vertices[b] = fitted.vertices[[a, b, c, d]].T @ [0.4, -0.05, 0.4, 0.25]
    monkeypatch.setattr(finer_fits, "fit", lambda *_, **__: fitted)
    polygons = mesh[1].ravel(), np.arange(0, mesh[1].size + 1, 4)
    finer = finer_fits.FinerFits(mesh[0], polygons, {"levels": 1}, {}).at(3)
    assert len(finer.faces[0]) == 0 and change_between(fitted, finer, 3, 2).max() < 1e-12
    assert len(finer.triangles) == 16 * few
    sides = np.stack([finer.faces[1], np.roll(finer.faces[1], -1, axis=1)], 2).reshape(-1, 2)
    pairs = {tuple(side) for side in sides.tolist()}
    assert len(pairs) == len(sides) and all((b, a) in pairs for a, b in pairs)


@pytest.mark.parametrize(
    ("noise", "tolerance", "share_of_noise"),
    [(NOISE, None, 0.98), (NOISE, 2e-3, 0), (0.0, None, 0)],
)
def test_patches_near_a_scan_may_be_off_by_half_of_what_it_is(
    cage, noise, tolerance, share_of_noise
):
    given = {"points": blob_scan(12_000, noise)}
    patches = df.fit_patches(*cage, scan=given, levels=3, tolerance=tolerance)
    wanted = share_of_noise * noise / patches.size or tolerance or 1e-4
    assert patches.tolerance == pytest.approx(wanted, rel=0.1)
    corners = np.asarray(cage[0])[np.asarray(cage[1])]
    edge = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean() / patches.size
    assert patches.normal_tolerance == pytest.approx(max(8e-4, patches.tolerance / edge), rel=0.1)


def test_what_would_fold_is_rounded_off():
    """A ridge that is two fifths of the cage's edges wide and 1.4 of one high; else its foot folds by 173°."""
    fine = np.linspace(-1, 1, 241)
    ridge = sheet(fine, fine, lambda x, y: 0.7 * np.clip(1 - np.abs(x - 0.2) / 0.1, 0, None))
    points, triangles = cut_quads(ridge)
    coarse = np.linspace(-1, 1, 5)
    cage = sheet(coarse, coarse, lambda x, y: 0 * x)
    found = df.fit(*cage, points, triangles=triangles, levels=5)
    assert turns(found.vertices, found.faces[1])[2].max() < np.pi / 2


@pytest.mark.parametrize("change", [lambda v: 3 * v, lambda v: v + [3, 0, 0]])
def test_a_cage_that_the_scan_hardly_covers_is_said(cage, scan, change):
    fitted = df.fit(change(cage[0]), cage[1], scan[::5])
    (warning,) = [w for w in fitted.report["warnings"] if w["code"] == "MOSTLY_UNCOVERED"]
    assert "nearer to the scan" in warning["message"]


@pytest.mark.parametrize(
    ("along", "said"), [((0.4, 0.1, 0.7), "on one line"), ((0, 0, 0), "in one place")]
)
def test_points_of_no_surface_are_refused(cage, along, said):
    points = np.array([0.3, 0.2, 0.1]) + np.linspace(-1, 1, 500)[:, None] * along
    error = refusal(df.fit, *cage, points.astype(np.float32))
    assert error.code == "BAD_SHAPE" and said in str(error)


def test_scan_of_a_plane_leaves_a_closed_cage_whole(cage):
    random = np.random.default_rng(2)
    plane = np.column_stack([random.uniform(-0.8, 0.8, (4000, 2)), np.full(4000, 0.75)])
    fitted = df.fit(*cage, plane)
    extent = np.ptp(fitted.vertices, axis=0) / np.ptp(cage[0], axis=0)
    assert (extent > 0.8).all() and (extent < 1.3).all()


def test_faces_have_the_ids_of_the_input_if_it_was_mended(cage, scan):
    """Faces after one that mending drops had each other's."""
    vertices, faces = cage
    half = scan[scan[:, 2] > 0.0]
    plain = df.fit(vertices, faces, half, levels=1)
    twice = df.fit(vertices, [faces[0], *faces], half, levels=1, repair="mend")
    assert np.isnan(twice.coverage[1])
    assert np.array_equal(np.delete(twice.coverage, 1), plain.coverage)
    ids = np.delete(np.arange(len(faces) + 1), 1)
    assert np.array_equal(twice.faces_of_points, ids[plain.faces_of_points])
    assert np.array_equal(twice.too_coarse, ids[plain.too_coarse])
    assert 0 < np.count_nonzero(plain.coverage == 0.0) < len(faces)


def test_memory_is_predicted(cage, scan):
    report = df.fit(*cage, np.tile(scan, (4, 1)), levels=4).report
    assert 0.5 * report["predicted_bytes"] < report["peak_bytes"] < 1.5 * report["predicted_bytes"]
    assert refusal(df.fit, *cage, scan, levels=4, memory_limit=1_000_000).code == "TOO_LARGE"
