# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of symmetric control meshes are symmetric to the last bit; others are left alone."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from refined import control_arrays, core_run
from scenes import add_suzanne

from addon.mesh.read import read_mesh
from addon.transfer.mirror import find_mirrors, symmetrize

# half a hexagon to either side of x = 0, and a triangle on top, whose tip lies on the plane
HOUSE = [(1, 0.5, 0.3), (-1, 0.5, 0.3), (-1.5, -0.5, 0), (-0.5, -1.25, 0.25), (0.5, -1.25, 0.25)]
HOUSE += [(1.5, -0.5, 0), (0, 2, 0.5)]
HOUSE_FACES = [[0, 1, 2, 3, 4, 5], [1, 0, 6]]


def suzanne():
    return read_mesh(add_suzanne().data)


def cube():
    bpy.ops.mesh.primitive_cube_add()
    return read_mesh(bpy.context.object.data)


def house():
    return control_arrays(HOUSE, HOUSE_FACES)


def run(arrays, levels=3, **settings):
    result, transfer = core_run(arrays, levels, **settings)
    mirrors, notes = find_mirrors(transfer, arrays, result.crease_edges)
    return SimpleNamespace(
        arrays=arrays,
        result=result,
        transfer=transfer,
        mirrors=mirrors,
        notes=notes,
        vertices=symmetrize(result.vertices, mirrors, arrays.positions),
    )


def differences(vertices, mirror):
    """Coordinates that do not equal their mirror image's, in single precision."""
    single = vertices.astype(np.float32)
    image = single[mirror.fine]
    image[:, mirror.axis] *= -1
    return int((image != single).sum())


@pytest.mark.parametrize("make, axes", [(suzanne, [0]), (cube, [0, 1, 2]), (house, [0])])
@pytest.mark.parametrize("levels", [0, 1, 3])
def test_exact_in_single_precision(make, axes, levels):
    made = run(make(), levels)
    assert [m.axis for m in made.mirrors] == axes and made.notes == []
    for mirror in made.mirrors:
        assert (mirror.fine >= 0).all()
        assert np.array_equal(mirror.fine[mirror.fine], np.arange(len(made.vertices)))
        assert differences(made.vertices, mirror) == 0
        assert (made.vertices[mirror.fine == np.arange(len(made.vertices)), mirror.axis] == 0).all()


@pytest.mark.parametrize("make", [suzanne, cube, house])
def test_nothing_moves_far_and_control_vertices_not_at_all(make):
    made = run(make())
    # the two sides differ by what rounding becomes in a solve to 1e-4
    assert np.abs(made.vertices - made.result.vertices).max() < 1e-8
    count = len(made.arrays.positions)
    assert np.array_equal(made.vertices[:count], made.arrays.positions)


def test_creases_break_it_with_a_note():
    arrays = cube()
    along_x = [e for e in arrays.edges.tolist() if np.ptp(arrays.positions[e], axis=0)[0]]
    made = run(arrays, crease_edges=along_x[:1])
    assert [m.axis for m in made.mirrors] == [0]
    assert differences(made.vertices, made.mirrors[0]) == 0
    assert len(made.notes) == 2 and all("creases are not" in note for note in made.notes)


def test_keys_that_are_not_symmetric_are_left_alone():
    made = run(house())
    wink = made.arrays.positions.copy()
    wink[0, 2] += 1
    made_of = made.result.vertices
    rough = made_of + np.random.default_rng(4).normal(scale=1e-9, size=made_of.shape)
    assert symmetrize(rough, made.mirrors, wink) is rough
    assert differences(symmetrize(rough, made.mirrors, made.arrays.positions), made.mirrors[0]) == 0
    bent = made_of.copy()
    bent[-1] += 0.1
    assert symmetrize(bent, made.mirrors) is bent, "that is no rounding"
