# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes, areas and hydrostatics against closed forms: Wigley's hull and an ellipsoid."""

import numpy as np
import pytest
from lattices import lattice_faces

from addon.yard.hydrostatics import NotClosed, hydrostatics, open_edges, solid

pytestmark = pytest.mark.plain

LENGTH, BEAM, DRAUGHT = 10.0, 1.0, 0.625  # of Wigley's hull


def sheet(place, along, up):
    """Triangles over a grid of `place(u, v)`, u and v from 0 to 1."""
    u, v = np.meshgrid(np.linspace(0, 1, along + 1), np.linspace(0, 1, up + 1), indexing="ij")
    quads = lattice_faces(*u.shape)
    triangles = np.concatenate([quads[:, [0, 2, 1]], quads[:, [0, 3, 2]]])
    return np.stack(place(u.ravel(), v.ravel()), axis=1), triangles


def wigley(u, v):
    """The half with y >= 0, from the keel at z = -DRAUGHT to the waterline, and straight up above it."""
    x, z = (u - 0.5) * LENGTH, DRAUGHT * (1.4 * v - 1.0)
    below = np.minimum(z, 0.0) / DRAUGHT
    return x, 0.5 * BEAM * (1 - (2 * x / LENGTH) ** 2) * (1 - below**2), z


def ellipsoid(a=3.0, b=2.0, c=1.0, count=160):
    points, triangles = sheet(
        lambda u, v: (
            a * np.cos(2 * np.pi * u) * np.sin(np.pi * v),
            b * np.sin(2 * np.pi * u) * np.sin(np.pi * v),
            -c * np.cos(np.pi * v),
        ),
        2 * count,
        count,
    )
    _, first, same = np.unique(points.round(9), axis=0, return_index=True, return_inverse=True)
    triangles = same.ravel()[triangles]
    sides = np.stack([triangles, np.roll(triangles, -1, axis=1)])
    return points[first], triangles[(sides[0] != sides[1]).all(axis=1)][:, ::-1]


def test_wigleys_hull():
    points, triangles = sheet(wigley, 160, 98)
    found = hydrostatics(points, triangles, 0.0)
    assert found.volume == pytest.approx(4 / 9 * LENGTH * BEAM * DRAUGHT, rel=1e-3)
    assert found.waterplane == pytest.approx(2 / 3 * LENGTH * BEAM, rel=1e-3)
    assert found.buoyancy == pytest.approx([0, 0, -3 / 8 * DRAUGHT], abs=1e-3 * DRAUGHT)
    assert found.transverse == pytest.approx(4 / 105 * LENGTH * BEAM**3, rel=1e-3)
    assert found.wetted == pytest.approx(14.8790, rel=1e-3), "by quadrature, both sides"
    assert (found.length, found.beam) == pytest.approx((LENGTH, BEAM), rel=1e-3)
    assert found.block_coefficient(DRAUGHT) == pytest.approx(4 / 9, rel=1e-3)


def test_an_ellipsoid_whole_and_afloat():
    points, triangles = ellipsoid()
    assert not len(open_edges(triangles))
    whole = solid(points + [5.0, 1.0, 0.5], triangles)
    assert whole.volume == pytest.approx(8 * np.pi, rel=1e-3)
    assert whole.area == pytest.approx(48.8822, rel=1e-3)
    assert whole.centroid == pytest.approx([5.0, 1.0, 0.5], abs=1e-3)
    found = hydrostatics(points, triangles, -0.5)  # a cap of half its depth: 5/32 of it
    assert found.volume == pytest.approx(8 * np.pi * 5 / 32, rel=1e-3)
    assert found.waterplane == pytest.approx(6 * np.pi * 0.75, rel=1e-3)
    assert found.buoyancy[2] == pytest.approx(-27 / 40, rel=1e-3)


@pytest.mark.parametrize("trim", [0.1, -0.25])
def test_trim_turns_the_waterplane(trim):
    """The waterplane passes through the middle of a box, which stays half under it."""
    points, triangles = sheet(lambda u, v: (u, v, 0 * u), 1, 1)
    box = np.concatenate([points, points + [0, 0, 1]]) * [4.0, 1.0, 2.0]
    faces = [(0, 2, 6, 4), (1, 5, 7, 3), (0, 4, 5, 1), (2, 3, 7, 6), (0, 1, 3, 2), (4, 6, 7, 5)]
    cut = np.array([[f[0], f[k], f[k + 1]] for f in faces for k in (1, 2)])
    sign = np.sign(solid(box, cut).volume)
    cut = cut if sign > 0 else cut[:, ::-1]
    found = hydrostatics(box, cut, 1.0, trim, pivot=2.0)
    assert found.volume == pytest.approx(4.0)
    assert found.waterplane == pytest.approx(4.0 / np.cos(trim))
    assert found.length == pytest.approx(4.0 / np.cos(trim))
    # a wedge of depth 2 tan(trim) moves by two thirds of the length
    moved = (0.5 * 2.0 * 2.0 * np.tan(trim)) * (2 * 4.0 / 3.0) / 4.0
    assert found.buoyancy[0] == pytest.approx(2.0 + moved)


def test_what_is_open_below_the_water_is_refused():
    points, triangles = sheet(wigley, 20, 14)
    with pytest.raises(NotClosed):
        solid(points, triangles)
    with pytest.raises(NotClosed):
        hydrostatics(points + [0, 0.2, 0], triangles, 0.0)
    with pytest.raises(NotClosed):
        hydrostatics(points, triangles[40:], 0.0)
