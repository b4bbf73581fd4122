# SPDX-License-Identifier: GPL-3.0-or-later
"""Half a mesh with a symmetry plane: errors, warnings and repairs name its own elements."""

import discrete_fairing as df
import numpy as np
import pytest
from half_hulls import hull


def failure(points, faces, call=df.fair, **options):
    with pytest.raises(df.FairingError) as caught:
        call(points, faces, 2, symmetry_plane="y", **options)
    return caught.value


def alone(points, faces, **options):
    """What the same mesh is told that is no half."""
    with pytest.raises(df.FairingError) as caught:
        df.fair(points, faces, 2, **options)
    return caught.value


def told(error):
    return error.code, error.kind, error.elements, str(error)


def turned():
    points, faces = hull()
    faces[7] = faces[7][::-1]
    return points, faces, {}


def twice():
    points, faces = hull()
    return points, np.concatenate([faces, faces[4:6]]), {}


def infinite():
    points, faces = hull()
    points[7] = np.inf
    return points, faces, {}


def no_such_crease():
    return *hull(), {"crease_edges": [[9, 18], [5, 9]]}


def no_such_corner():
    return *hull(), {"corner_vertices": [3, 28]}


def no_such_face_in_the_region():
    return *hull(), {"region": [0, 18]}


def no_such_vertex_in_a_face():
    points, faces = hull()
    faces[3, 2] = 28
    return points, faces, {}


CASES = [turned, twice, infinite, no_such_crease]


@pytest.mark.parametrize("make", CASES)
@pytest.mark.parametrize("call", [df.fair, df.Solver])
def test_an_error_is_that_of_the_half_alone(make, call):
    points, faces, options = make()
    assert told(failure(points, faces, call, **options)) == told(alone(points, faces, **options))


@pytest.mark.parametrize(
    ("make", "kind", "elements"),
    [
        (no_such_corner, "vertex", [28]),
        (no_such_face_in_the_region, "face", [18]),
        (no_such_vertex_in_a_face, "vertex", [28]),
    ],
)
def test_ids_that_only_the_image_has_are_refused(make, kind, elements):
    points, faces, options = make()
    error = failure(points, faces, **options)
    assert (error.code, error.kind, error.elements) == ("INDEX_OUT_OF_RANGE", kind, elements)
    assert str(error).startswith(f"1 {kind} ({elements[0]}) is named in ")


def test_warnings_and_repairs_name_the_half_too():
    points, faces = hull()
    points = np.concatenate([points, [[0, 5, 0]]])
    faces = np.concatenate([faces, faces[4:6]])
    faces[9] = faces[9][::-1]
    report = df.fair(points, faces, 2, symmetry_plane="y", repair="mend").report
    expected = df.fair(points, faces, 2, repair="mend").report
    for name in ("warnings", "repairs", "flipped_faces"):
        assert report[name] == expected[name], name
