# SPDX-License-Identifier: GPL-3.0-or-later
"""The control mesh over a network of curves, and the surface through it. No Blender."""

import networks
import numpy as np
import pytest

from addon.curves.cells import find_cells
from addon.curves.control_mesh import control_mesh
from addon.curves.cubics import points_at
from addon.curves.network import network
from addon.curves.settle import CoverOptions, covered
from addon.errors import JobError

pytestmark = pytest.mark.plain

df = pytest.importorskip("discrete_fairing")

ALL = [
    networks.three_by_four,
    networks.bonnet,
    networks.hull,
    networks.great_circles,
    networks.tube,
    networks.loop,
]
POLYGONS = [lambda sides=sides: networks.polygon(sides) for sides in (3, 5, 6, 7)]


def meshed(curves, per_side=4):
    return control_mesh(find_cells(network(curves)), per_side)


def faired(mesh, energy="minimum_variation", levels=2):
    return df.fair(
        mesh.points,
        mesh.faces,
        levels=levels,
        energy=energy,
        interpolation="approximate",
        tolerance=0.0,
        weights=np.where(mesh.held, np.inf, 0.0),
        crease_edges=mesh.sharp,
    )


def off(points, curves):
    """(n,): how far each is from the nearest of `curves`."""
    dense = [points_at(c.pieces, np.linspace(0, c.end, 100 * len(c.pieces) + 1)) for c in curves]
    start = np.concatenate([chain[:-1] for chain in dense])
    way = np.concatenate([np.diff(chain, axis=0) for chain in dense])
    found = []
    for p in points:
        share = np.einsum("ij,ij->i", p - start, way) / np.einsum("ij,ij->i", way, way)
        near = start + np.clip(share, 0, 1)[:, None] * way
        found.append(np.linalg.norm(near - p, axis=1).min())
    return np.array(found)


@pytest.mark.parametrize("make", [*ALL, *POLYGONS])
@pytest.mark.parametrize("per_side", [1, 4, 5])
def test_the_mesh_is_sound_and_its_held_vertices_lie_on_the_curves(make, per_side):
    mesh = meshed(make(), per_side)
    assert [d.code for d in df.check(mesh.points, mesh.faces)] == []
    assert off(mesh.points[mesh.held], make()).max() < 1e-4
    assert len(mesh.cell_of_face) == len(mesh.faces)


def test_three_great_circles_are_a_sphere():
    mesh = covered(networks.great_circles(), CoverOptions()).mesh
    surface = faired(mesh)
    assert np.abs(np.linalg.norm(surface.vertices, axis=1) - 1).max() < 5e-4


def test_it_looks_outwards_and_up():
    for make in (networks.three_by_four, networks.great_circles):
        mesh = meshed(make())
        a, b, c, d = mesh.points[mesh.faces].swapaxes(0, 1)
        out = (a + b + c + d) / 4 if make is networks.great_circles else (0, 0, 1)
        assert (np.cross(c - a, d - b) * out).sum() > 0


def test_what_is_no_network_is_refused_in_words():
    with pytest.raises(JobError, match="none with two points"):
        covered([], CoverOptions())
    wrong = networks.polygon(3)
    wrong[0].pieces[0, 0, 0] = np.nan
    with pytest.raises(JobError, match="the point of 'Side 0'"):
        covered(wrong, CoverOptions())
    with pytest.raises(JobError, match="Lower Edges per Side"):
        covered(networks.three_by_four(), CoverOptions(per_side=100))


def test_a_mesh_keeps_its_faces_while_curves_are_drawn_about():
    curves = networks.three_by_four()
    first = covered(curves, CoverOptions()).mesh
    stretched = [c if c.name != "Column 2" else networks.across(c.name, 0.55) for c in curves]
    assert not np.array_equal(covered(stretched, CoverOptions()).mesh.counts, first.counts)
    second = covered(stretched, CoverOptions(), first.counts).mesh
    assert np.array_equal(second.faces, first.faces)
    finer = covered(curves, CoverOptions(per_side=8), first.counts).mesh
    assert len(finer.faces) > 3 * len(first.faces)


def test_a_closed_end_does_not_swell():
    """A tube of radius 1 with filled ends: without held vertices, minimum variation swells them by 1.03."""
    mesh = covered(networks.tube(), CoverOptions(closed=True)).mesh
    surface = faired(mesh, levels=1)
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    points = surface.vertices
    assert (points > low - 0.1).all() and (points < high + 0.1).all()
    # a sheet within a loop is free
    assert not covered(networks.loop(), CoverOptions()).mesh.held.all()
