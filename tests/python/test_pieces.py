# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces in pieces against surfaces of the whole mesh."""

import pickle
from functools import cache

import discrete_fairing as df
import numpy as np
import pytest
from piece_meshes import MESHES, ring, torus
from refusing import refusal

TIGHT = {"relative_residual": 1e-11}  # loads on pads then end far below the differences here


def bound(rings):
    """The largest difference from the whole, as a share of its size (docs/how-to/pieces.md)."""
    return 5e-3 * 2.6**-rings


@cache
def whole_of(name):
    points, faces, settings = MESHES[name]
    return df.fair(points, faces, 2, **TIGHT, **settings)


def cut(points, faces, levels=2, count=3, rings=4, **settings):
    return df.pieces(points, faces, levels, count=count, rings=rings, **{**TIGHT, **settings})


def in_pieces(*mesh, **settings):
    return df.join(piece.fair() for piece in cut(*mesh, **settings))


def difference(joined, whole, points):
    known = points[np.isfinite(points).all(axis=1)]
    gap = np.linalg.norm(joined.vertices - whole.vertices, axis=1).max()
    return gap / np.ptp(known, axis=0).max()


def assert_same_topology(joined, whole):
    for mine, theirs in zip(joined.faces, whole.faces):
        assert np.array_equal(mine, theirs) and mine.dtype == theirs.dtype
    for name in ("triangle_polygon", "quad_polygon", "crease_edges"):
        assert np.array_equal(getattr(joined, name), getattr(whole, name)), name


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize(("count", "rings"), [(3, 5), (10, 3), (40, 2)])
def test_pieces_are_the_whole(name, count, rings):
    points, faces, settings = MESHES[name]
    whole = whole_of(name)
    joined = in_pieces(points, faces, count=count, rings=rings, **settings)
    assert_same_topology(joined, whole)
    assert difference(joined, whole, points) < bound(rings)
    jump = joined.report["pieces"]["jump"]
    assert joined.report["pieces"]["count"] == count
    assert 0 <= jump["share"] < 2 * bound(rings)  # of two that both may be off
    # Pieces are worst at their seams, where two pieces differ by about their errors; but on the even strip
    # pieces are images of each other and have the same error.
    assert name == "one-sided" or difference(joined, whole, points) < 5 * jump["share"] + 1e-8


@pytest.mark.parametrize("name", MESHES)
def test_one_piece_is_the_whole_to_the_last_bit(name):
    points, faces, settings = MESHES[name]
    joined, whole = in_pieces(points, faces, count=1, **settings), whole_of(name)
    assert_same_topology(joined, whole)
    if name == "defects":  # without the vertices that no face has, sums run over other blocks
        assert np.allclose(joined.vertices, whole.vertices, rtol=0, atol=1e-9)
        return
    assert np.array_equal(joined.vertices, whole.vertices)
    assert joined.report["pads"]["widths"] == whole.report["pads"]["widths"]
    for key in ("iterations", "residuals", "converged", "sheets", "repairs", "flipped_faces"):
        assert joined.report[key] == whole.report[key], key
    assert [w["code"] for w in joined.report["warnings"]] == [
        w["code"] for w in whole.report["warnings"]
    ]


@pytest.mark.parametrize("name", ["open creases and corners", "border", "book", "folded"])
def test_curves_are_the_whole_s_bit_for_bit(name):
    points, faces, settings = MESHES[name]
    whole, n = whole_of(name), 4
    joined = in_pieces(points, faces, count=10, rings=1, **settings)
    polygons = [tuple(face) for face in faces]
    sides = {}
    for face in polygons:
        for a, b in zip(face, face[1:] + face[:1]):
            sides.setdefault(frozenset((int(a), int(b))), len(sides))
    uses = [frozenset((int(a), int(b))) for f in polygons for a, b in zip(f, f[1:] + f[:1])]
    border = {edge for edge in sides if uses.count(edge) == 1}
    curves = border | {frozenset(map(int, edge)) for edge in whole.crease_edges}
    assert curves
    edges = [sides[edge] for edge in curves]  # the core numbers edges as faces name them first
    rows = len(points) + np.array(edges)[:, None] * (n - 1) + np.arange(n - 1)
    assert np.array_equal(joined.vertices[rows], whole.vertices[rows])


def test_every_point_has_one_owner():
    points, faces, settings = MESHES["triangle book"]
    parts = [piece.fair() for piece in cut(points, faces, count=7, rings=2, **settings)]
    ids = np.concatenate([part.ids for part in parts])
    assert np.array_equal(np.sort(ids), np.arange(len(whole_of("triangle book").vertices)))
    joined = df.join(reversed(parts))
    for part in parts:
        assert np.array_equal(joined.vertices[part.ids], part.vertices)
        shared = part.seam_ids
        assert not np.isin(shared, part.ids).any()
    faces_of_parts = np.concatenate([part.faces[0] for part in parts])
    assert len(np.unique(faces_of_parts, axis=0)) == len(joined.faces[0])


def test_a_piece_gives_the_same_bits_wherever_it_is_faired():
    piece = cut(*MESHES["noisy triangles"][:2])[1]
    here = piece.fair(threads=1)
    part = pickle.loads(pickle.dumps(piece)).fair(threads=3)
    assert np.array_equal(part.vertices, here.vertices)
    assert np.array_equal(part.ids, here.ids)
    assert np.array_equal(part.seam_points, here.seam_points)


def test_the_same_pieces_on_every_call():
    first, again = (cut(*torus(noise=0.02), count=5) for _ in range(2))
    assert [pickle.dumps(piece) for piece in first] == [pickle.dumps(piece) for piece in again]
    owned = [int(piece.owned.sum()) for piece in first]
    assert sum(owned) == 288 and max(owned) < 1.2 * min(owned)


# --- settings ---

N = len(torus()[0])
NEAR = {"interpolation": "approximate"}


@pytest.mark.parametrize(
    ("settings", "rings", "most"),
    [
        ({"tension": 0.5}, 5, bound(5)),
        ({"metric_exponent": 1.0, "chart": "tangent"}, 5, bound(5)),
        ({"epsilon": 1e-3}, 5, bound(5)),
        ({"method": "back_leg"}, 5, bound(5)),
        ({"pad_size": 0.0}, 5, bound(5)),
        ({"energy": "total_curvature", "relative_residual": 1e-7}, 5, bound(5)),
        ({"energy": "minimum_variation", "relative_residual": 1e-7}, 5, 3 * bound(5)),
        # Vertices that give way pass changes on farther than fixed ones.
        ({**NEAR, "weights": np.linspace(1, 3, N)}, 6, 3e-4),
        ({**NEAR, "tolerance": np.linspace(0.002, 0.004, N)}, 6, 3e-4),
        ({"region": np.arange(60, 150)}, 5, bound(5)),
        ({"region": np.arange(60, 150), "joint": "curvature"}, 5, 2 * bound(5)),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else "",
)
def test_settings_are_cut_out_with_pieces(settings, rings, most):
    mesh = torus()
    whole = df.fair(*mesh, 2, **{**TIGHT, **settings})
    joined = in_pieces(*mesh, rings=rings, **settings)
    assert difference(joined, whole, mesh[0]) < most
    assert joined.report["largest_deviation"] == pytest.approx(
        whole.report["largest_deviation"], rel=0.05, abs=1e-12
    )


def test_whatever_fair_refuses_is_refused_before_any_piece():
    points, faces = torus()
    error = refusal(cut, points, np.concatenate([faces, faces[5:6]]))
    assert error.code == "DUPLICATE_FACE" and sorted(error.elements) == [5, 288]
    with pytest.raises(TypeError, match="no_such"):
        cut(points, faces, no_such=1)


def test_parts_that_do_not_belong_together_are_refused():
    parts = [piece.fair() for piece in cut(*torus(), levels=1)]
    other = cut(*torus(noise=0.01), levels=1)[2].fair()
    for wrong, message in (
        ([], "no parts"),
        (parts[:2], "missing: 2"),
        ([*parts, parts[1]], "Part 1 is given twice"),
        ([*parts[:2], other], "different surfaces"),
    ):
        with pytest.raises(df.FairingError, match=message):
            df.join(wrong)


# --- memory ---


def test_a_worker_needs_the_memory_of_its_piece():
    mesh = torus(64, 32)
    whole = df.fair(*mesh, 3)
    pieces = cut(*mesh, levels=3, count=8, rings=2, relative_residual=1e-4)
    parts = [piece.fair() for piece in pieces]
    share = max(len(piece.owned) for piece in pieces) / len(mesh[1])
    assert share < 0.3
    peak = max(part.report["peak_bytes"] for part in parts)
    assert peak < 1.2 * share * whole.report["peak_bytes"]
    assert all(part.report["peak_bytes"] <= part.report["predicted_bytes"] for part in parts)


def shapes_of(points):
    """A bent shape, the mesh itself, and a shape that bends more and more along x."""
    points = np.where(np.isfinite(points), points, 0.0)
    bent = points + 0.2 * np.sin(2 * points[:, [1, 2, 0]])
    share = (1 + np.tanh(points[:, :1])) / 2
    return np.stack([bent, points, points + share * (bent - points)])


@pytest.mark.parametrize("name", MESHES)
def test_shapes_are_cut_out_with_each_piece(name):
    points, faces, settings = MESHES[name]
    given = {**TIGHT, **settings, "shapes": shapes_of(points)}
    whole = df.fair(points, faces, 2, **given)
    joined = in_pieces(points, faces, rings=5, count=3, **given)
    assert len(joined.shapes) == len(joined.report["shapes"]) == 3
    for mine, theirs in zip(joined.shapes, whole.shapes):
        assert np.linalg.norm(mine - theirs, axis=1).max() / np.ptp(points, axis=0).max() < bound(5)
    for mine, theirs in zip(joined.report["shapes"], whole.report["shapes"]):
        assert mine.keys() == theirs.keys() and mine["converged"]
        assert mine["largest_deviation"] == pytest.approx(theirs["largest_deviation"], abs=1e-12)


@pytest.mark.parametrize("name", MESHES)
def test_through_limit_positions(name):
    points, faces, settings = MESHES[name]
    semi_sharp = {
        "edge_sharpness": (ring()[:9], 1.5) if "torus" in name or "crease" in name else ((), ()),
        "vertex_sharpness": np.arange(len(points)) % 7 / 4,
    }
    given = {**TIGHT, **settings, **semi_sharp, "interpolation": "limit", "tension": 0.3}
    whole = df.fair(points, faces, 2, shapes=shapes_of(points)[:1], **given)
    joined = in_pieces(points, faces, rings=5, count=3, shapes=shapes_of(points)[:1], **given)
    assert difference(joined, whole, points) < bound(5)
    gap = np.linalg.norm(joined.shapes[0] - whole.shapes[0], axis=1).max()
    assert gap / np.ptp(points, axis=0).max() < bound(5)
