# SPDX-License-Identifier: GPL-3.0-or-later
"""Each boundary edge can be curved, straight or free, independent of the others."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
import tight
from sheet_meshes import book
from surfaces import as_lists, boundary_vertices, output_faces

MODES = ("curve", "linear", "free")
ENERGIES = ("thin_plate", "total_curvature", "minimum_variation")
POINTS, FACES = meshes.wavy_patch()
BOTTOM = [(0, 1), (1, 2), (2, 3), (3, 4)]  # vertices 0 … 4 at y = 0


def border(faces):
    """All boundary edges, as vertex pairs."""
    lists = as_lists(faces)
    sides = [tuple(sorted(e)) for f in lists for e in zip(f, [*f[1:], f[0]])]
    return [e for e in sides if sides.count(e) == 1]


def rows(points):
    """Points to the last bit."""
    return {p.tobytes() for p in np.ascontiguousarray(points + 0.0)}


def on_edge(result, a, b):
    """Points of the refined border whose x is between that of two vertices of the bottom."""
    rim = result.vertices[boundary_vertices(output_faces(result))]
    low, high = sorted((POINTS[a, 0], POINTS[b, 0]))
    return rim[(rim[:, 0] > low) & (rim[:, 0] < high) & (rim[:, 1] < 0.5)]


def off_chord(points, a, b):
    way = (POINTS[b] - POINTS[a]) / np.linalg.norm(POINTS[b] - POINTS[a])
    away = points - POINTS[a]
    return np.linalg.norm(away - np.outer(away @ way, way), axis=1)


@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.parametrize("named", MODES)
def test_all_edges_by_name_are_the_setting(named, energy):
    other = MODES[MODES.index(named) - 1]
    given = df.fair(POINTS, FACES, 2, energy, boundary=other, boundary_edges={named: border(FACES)})
    whole = df.fair(POINTS, FACES, 2, energy, boundary=named)
    assert given.vertices.tobytes() == whole.vertices.tobytes()


def test_straight_edges_between_curves():
    result = tight.fair(POINTS, FACES, 3, boundary_edges={"linear": [(2, 1), (2, 3)]})
    for a, b in BOTTOM:
        points = on_edge(result, a, b)
        assert len(points) == 7
        assert (off_chord(points, a, b).max() < 1e-12) == ((a, b) in [(1, 2), (2, 3)])
    ends = tight.fair(POINTS, FACES, 3, corner_vertices=[1, 2, 3])
    assert np.abs(result.vertices - ends.vertices).max() < 1e-9, "they end the curves beside them"


def test_a_curve_within_straight_edges():
    given = tight.fair(
        POINTS, FACES, 3, boundary="linear", boundary_edges={"curve": [(1, 2), (2, 3)]}
    )
    alone = tight.fair(POINTS, FACES, 3, corner_vertices=[0, 1, 3, 4, 20, 24])
    for a, b in BOTTOM[1:3]:
        assert off_chord(on_edge(given, a, b), a, b).max() > 1e-3
        assert rows(on_edge(given, a, b)) == rows(on_edge(alone, a, b))
    straight = tight.fair(POINTS, FACES, 3, boundary="linear")
    rim = [v for v in boundary_vertices(output_faces(given)) if given.vertices[v, 1] > 0.5]
    assert given.vertices[rim].tobytes() == straight.vertices[rim].tobytes()


@pytest.mark.parametrize("energy", ENERGIES[:2])
def test_free_edges_go_with_the_surface_and_the_others_do_not(energy):
    moved = POINTS.copy()
    moved[12] += [0, 0, 0.4]
    still, after = (
        tight.fair(v, FACES, 3, energy, boundary_edges={"free": BOTTOM}) for v in (POINTS, moved)
    )
    rim = boundary_vertices(output_faces(still))
    inside = rim[rim >= len(POINTS)]
    change = np.abs(after.vertices - still.vertices).max(axis=1)
    at_bottom = still.vertices[:, 1] < 0.5
    free = inside[at_bottom[inside] & (change[inside] > 0)]
    assert len(free) == 4 * 7 and change[free].max() > 1e-3
    assert np.array_equal(still.vertices[: len(POINTS)], POINTS)


@pytest.mark.parametrize("kind", ["linear", "free"])
def test_edges_that_are_no_boundary_are_left_alone(kind):
    inside = df.fair(POINTS, FACES, 2, boundary_edges={kind: [(11, 12)]})
    assert inside.vertices.tobytes() == df.fair(POINTS, FACES, 2).vertices.tobytes()
    vertices, faces, _ = book()
    spine = [(0, 1), (1, 2)]
    met = df.fair(vertices, faces, 2, boundary_edges={kind: spine})
    assert met.vertices.tobytes() == df.fair(vertices, faces, 2).vertices.tobytes()


def test_half_a_mesh():
    """The seam is no boundary under any name, and the other half is the image."""
    points, quads = meshes.grid(4, 4)
    points[:, 2] = 0.3 * np.sin(points[:, 0] + points[:, 1])
    edges = {"linear": [(4, 9), (9, 14)], "free": [(0, 5), (20, 21), (21, 22)]}  # 0-5: on the seam
    half = df.fair(points, quads, 2, boundary_edges=edges, symmetry_plane="x")
    plain = df.fair(points, quads, 2, symmetry_plane="x")
    unnamed = edges | {"free": edges["free"][1:]}
    again = df.fair(points, quads, 2, boundary_edges=unnamed, symmetry_plane="x")
    assert half.vertices.tobytes() == again.vertices.tobytes()
    assert np.abs(half.vertices - plain.vertices).max() > 1e-3
    solver = df.Solver(points, quads, 2, boundary_edges=edges, symmetry_plane="x")
    assert solver.solve().vertices.tobytes() == half.vertices.tobytes()
