# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays of any layout, type and protection just work, give the same result, and are not changed."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest

POINTS, FACES = meshes.torus()
EXPECTED = df.fair(POINTS, FACES, 2)


def read_only(array):
    array = array.copy()
    array.flags.writeable = False
    return array


def strided(array):
    """Every other element of a larger array, the rest NaN or a wrong index."""
    wide = np.full(
        (2 * array.shape[0], 3 * array.shape[1]),
        np.nan if array.dtype.kind == "f" else -9,
        array.dtype,
    )
    wide[::2, 1::3] = array
    view = wide[::2, 1::3]
    assert not view.flags.c_contiguous
    return view


def backwards(array):
    """Negative strides."""
    return array[::-1, ::-1].copy()[::-1, ::-1]


def unaligned(array):
    raw = np.zeros(array.nbytes + 1, np.uint8)
    view = raw[1:].view(array.dtype).reshape(array.shape)
    view[...] = array
    assert not view.flags.aligned
    return view


LAYOUTS = {
    "read_only": read_only,
    "fortran": np.asfortranarray,
    "strided": strided,
    "backwards": backwards,
    "unaligned": unaligned,
    "big_endian": lambda a: a.astype(a.dtype.newbyteorder(">")),
    "list": np.ndarray.tolist,
    "tuples": lambda a: tuple(map(tuple, a.tolist())),
    "list_of_arrays": list,
    "subclass": lambda a: np.ma.masked_array(a),
}


def assert_same(result, expected=EXPECTED):
    assert result.vertices.tobytes() == expected.vertices.tobytes()
    assert result.triangles.tobytes() == expected.triangles.tobytes()


def snapshot(array):
    return array.tobytes() if isinstance(array, np.ndarray) else repr(array)


@pytest.mark.parametrize("layout", sorted(LAYOUTS))
def test_any_layout(layout):
    points, faces = LAYOUTS[layout](POINTS), LAYOUTS[layout](FACES)
    before = snapshot(points), snapshot(faces)
    assert_same(df.fair(points, faces, 2))
    assert (snapshot(points), snapshot(faces)) == before


@pytest.mark.parametrize("kind", "bBhHiIqQefdg")
def test_any_numbers(kind):
    """A float32 and the same number as float64 give the same surface."""
    points = (8 * (POINTS + 3)).astype(kind)
    faces = FACES if kind in "efdg" else FACES.astype(kind)
    assert_same(df.fair(points, faces, 2), df.fair(points.astype(float), FACES, 2))


def test_polygons_of_any_size_in_any_container():
    points, faces = meshes.mixed_house()
    expected = df.fair(points, faces, 2)
    ragged = np.empty(len(faces), object)
    ragged[:] = faces
    flat = np.concatenate([np.array(f) for f in faces]), np.cumsum([0, *map(len, faces)])
    pairs = [tuple(part.astype(kind) for part in flat) for kind in "iqI"]
    arrays = [np.array(f, np.uint8) for f in faces]
    for other in (ragged, arrays, tuple(map(tuple, faces)), *pairs):
        assert_same(df.fair(points, other, 2), expected)


def test_results_are_the_callers_own():
    """Writable, and alive after the result is gone."""
    result = df.fair(POINTS, FACES, 1)
    vertices, quads = result.vertices, result.faces[1]
    del result
    vertices += 1
    assert np.array_equal(vertices[: len(POINTS)], POINTS + 1) and quads.max() == len(vertices) - 1
    assert_same(df.fair(POINTS, FACES, 2))
