# SPDX-License-Identifier: GPL-3.0-or-later
"""Real meshes: the good ones converge, the bad ones end in success or a named error."""

import discrete_fairing as df
import numpy as np
import pytest
import tight
from mesh_files import SUFFIXES, read_mesh
from shared_data import SHARED, creases_of, shared_files
from test_converged import assert_honest
from test_folds import own_folds

MOST_FACES = 1200
# What is left at level 2 (docs/developers/notes/steps.md).
FOLDS_LEFT = {"catmark_lefthanded": 2, "catmark_righthanded": 15}
CODES = {
    "EMPTY_MESH",
    "NO_FACES",
    "BAD_SHAPE",
    "NON_FINITE",
    "INDEX_OUT_OF_RANGE",
    "REPEATED_VERTEX",
    "DUPLICATE_FACE",
    "INCONSISTENT_ORIENTATION",
    "NON_ORIENTABLE",
    "DEGENERATE_FACE",
    "COINCIDENT_VERTICES",
}


def assert_sound(result, vertices):
    assert np.isfinite(result.vertices).all()
    assert result.vertices[: len(vertices)].tobytes() == vertices.tobytes()


def creases_in(path, faces):
    """The listed ones that are there: some lists name an edge of a face that the file does not have."""
    edges, corners = creases_of(path, sharper_than=2.0)
    there = {frozenset(e) for f in faces for e in zip(f, [*f[1:], f[0]])}
    return [e for e in edges.tolist() if frozenset(e) in there], corners


@pytest.mark.parametrize("path", shared_files("good", *SUFFIXES))
def test_good_meshes_converge(path):
    vertices, faces = read_mesh(path)
    if len(faces) > MOST_FACES:
        pytest.skip("large")
    edges, corners = creases_in(path, faces)
    options = [{}]
    if len(edges) + len(corners):
        options.append({"crease_edges": edges, "corner_vertices": corners})
    for option in options:
        result = tight.fair(vertices, faces, 2, threads=1, **option)
        assert_sound(result, vertices)
        assert result.report["converged"]
        assert max(result.report["iterations"]) <= 40
        curved = tight.fair(vertices, faces, 2, "total_curvature", **option)
        assert_sound(curved, vertices)
        assert_honest(curved)
        finest = curved.report["curvature"][-1]
        assert 0 <= finest["energy"] <= finest["plate_energy"]
        assert finest["folds"] <= finest["folds_before"]
        if not option:
            left = FOLDS_LEFT.get(path.stem.rpartition("__")[2], 0)
            assert own_folds(curved, (vertices, faces)) <= left


def test_slits_decide_where_concave_faces_are_warped():
    """Through its vertices a fish's fin passes through itself; two of its pentagons see a side past 90 degrees."""
    path = SHARED / "good/cages/odedstein-meshes__fish_fish_control_mesh.obj"
    if not path.exists():
        pytest.skip("no shared meshes")
    auto, limit = (
        df.fair(*read_mesh(path), 1, interpolation=i).vertices for i in ("auto", "limit")
    )
    assert np.array_equal(auto, limit)


@pytest.mark.parametrize("path", shared_files("bad", *SUFFIXES))
@pytest.mark.parametrize(
    "options", [{}, {"repair": "mend"}, {"repair": "mend", "weld": 0}], ids=str
)
def test_bad_meshes_end_well(path, options):
    """Mending leaves sheets that meet, and one-sided ones."""
    try:
        vertices, faces = read_mesh(path)
    except ValueError as error:
        pytest.skip(f"the reader refuses it: {error}")
    try:
        result = tight.fair(vertices, faces, 1, **options)
    except df.FairingError as error:
        assert error.code in CODES and len(str(error)) > 15
        assert error.elements or error.code in ("EMPTY_MESH", "NO_FACES")
        broken = {"EMPTY_MESH", "INDEX_OUT_OF_RANGE"} if "corrupt_files" in path.parts else set()
        assert not options or error.code in {"NON_ORIENTABLE"} | broken
        return
    assert np.isfinite(result.vertices).all() and result.report["converged"]
    assert "weld" in options or result.vertices[: len(vertices)].tobytes() == vertices.tobytes()
    assert not options or "degenerate" not in path.parts or result.report["repairs"]
    polygons = np.concatenate([result.triangle_polygon, result.quad_polygon])
    assert polygons.min() >= 0 and polygons.max() < len(faces)
