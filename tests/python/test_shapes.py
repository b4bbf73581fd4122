# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes are further positions, solved on the charts of the first, so by one linear map."""

import numpy as np
import pytest
import tight
from moving import moved, sample
from surfaces import size_of

SAMPLES = ["icosahedron", "cube", "dodecahedron", "house", "creature", "wavy_patch", "roof"]


@pytest.mark.parametrize("name", SAMPLES)
def test_control_rows_are_exact_and_the_basis_is_the_first_surface(name):
    vertices, faces = sample(name)
    shape = moved(vertices, 0.2, 1)
    result = tight.fair(vertices, faces, 3, shapes=[shape, vertices, shape])
    plain = tight.fair(vertices, faces, 3)
    assert np.array_equal(result.vertices, plain.vertices)
    assert [s.shape for s in result.shapes] == 3 * [result.vertices.shape]
    assert np.array_equal(result.shapes[0][: len(vertices)], shape)
    assert np.array_equal(result.shapes[1], result.vertices)
    assert np.array_equal(result.shapes[2], result.shapes[0])
    assert len(result.report["shapes"]) == 3 and result.report["converged"]
    for entry in result.report["shapes"]:
        assert entry["converged"] and entry["residual"] <= 1e-8 and entry["largest_deviation"] == 0


TAUT = {"tension": 0.7, "relative_residual": 1e-12}
JOINTS = ("position", "tangent", "curvature")
WEIGHTS = np.random.default_rng(3).uniform(0.5, 20, 98)


@pytest.mark.parametrize(
    "name, options",
    [(name, {"boundary": kind}) for name in SAMPLES for kind in ("curve", "linear", "free")]
    + [
        ("icosahedron", {"method": "back_leg"}),
        ("creature", TAUT),
        ("creature", TAUT | {"pad_size": 0.5}),
        ("creature", {"pad_size": 0.5, "relative_residual": 1e-12}),
        ("creature", {"interpolation": "approximate", "weights": WEIGHTS}),
        ("roof", {"crease_angle": 0.8}),
    ]
    + [("dodecahedron", {"region": [0, 1, 2], "joint": joint}) for joint in JOINTS],
    ids=str,
)
def test_mixes_are_linear(name, options):
    vertices, faces = sample(name)
    a, b = moved(vertices, 0.2, 1), moved(vertices, 0.5, 2) * [1, -2, 1] + [3, 0, 0]
    result = tight.fair(
        vertices,
        faces,
        3,
        shapes=[a, b, 0.3 * a + 0.7 * b, 2 * a - b, vertices + (a - b)],
        **options,
    )
    of_a, of_b, mix, beyond, offset = result.shapes
    tolerance = 1e-6 * size_of(b)
    assert np.abs(mix - (0.3 * of_a + 0.7 * of_b)).max() < tolerance
    assert np.abs(beyond - (2 * of_a - of_b)).max() < tolerance
    assert np.abs(offset - (result.vertices + of_a - of_b)).max() < tolerance


@pytest.mark.parametrize("name", SAMPLES)
def test_an_affine_image_has_the_affine_surface(name):
    vertices, faces = sample(name)
    matrix = np.array([[1, 0.4, 0], [-0.2, 3, 0.1], [0, 0, 0.5]])
    result = tight.fair(vertices, faces, 3, shapes=[vertices @ matrix + [4, 5, 6]])
    assert np.abs(result.shapes[0] - (result.vertices @ matrix + [4, 5, 6])).max() < 1e-6 * size_of(
        vertices
    )


def test_a_shape_is_not_the_mesh_of_its_own():
    """Its charts are those of the basis; a run of its own gives another surface."""
    vertices, faces = sample("creature")
    shape = vertices * [1, 1, 6.0]
    together = tight.fair(vertices, faces, 2, shapes=[shape]).shapes[0]
    assert np.abs(together - tight.fair(shape, faces, 2).vertices).max() > 1e-3


def test_every_shape_keeps_the_tolerance_about_its_own_places():
    vertices, faces = sample("creature")
    shapes = [moved(vertices, 0.1, k) for k in range(3)]
    result = tight.fair(
        vertices, faces, 2, interpolation="approximate", tolerance=0.04, shapes=shapes
    )
    reverse = tight.fair(
        vertices, faces, 2, interpolation="approximate", tolerance=0.04, shapes=shapes[::-1]
    )
    for k, shape in enumerate(shapes):
        away = np.linalg.norm(result.shapes[k][: len(vertices)] - shape, axis=1)
        entry = result.report["shapes"][k]
        assert 0.03 < away.max() <= 0.04 and entry["converged"] and entry["constraint_rounds"] > 0
        assert entry["largest_deviation"] == pytest.approx(away.max())
        assert np.array_equal(result.shapes[k], reverse.shapes[2 - k])
