# SPDX-License-Identifier: GPL-3.0-or-later
"""repair="mend" at random: sound, closed where it was, the same for any order."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from surfaces import as_lists, half_edges
from test_mend import mended_faces

# what mending leaves to others: sheets that meet, and one-sided ones
LEFT = {"NONMANIFOLD_EDGE", "NONMANIFOLD_VERTEX", "NON_ORIENTABLE"}


def with_caps(seed, edges=6):
    """A closed mesh with points on edges that one face knows, and faces without area between."""
    random = np.random.default_rng(seed)
    points, faces = meshes.icosahedron() if seed % 2 else meshes.random_hull(24, seed)
    faces = as_lists(faces)
    points = points.tolist()
    for f in random.choice(len(faces), edges, replace=False):
        side = random.integers(3)
        a, b, c = np.roll(faces[f], -side).tolist()
        shares = np.sort(random.uniform(0.05, 0.95, random.integers(1, 4)))
        between = []
        for share in shares:
            between.append(len(points))
            points.append(
                (np.array(points[a]) * (1 - share) + np.array(points[b]) * share).tolist()
            )
        chain = [a, *between, b]
        parts = [[v, w, c] for v, w in zip(chain, chain[1:])]
        faces[f] = parts[0]
        faces += parts[1:]
        # filled without area, as triangles about one end or as one polygon
        if random.integers(2):
            faces += [[a, w, v] for v, w in zip(chain[1:], chain[2:])]
        else:
            faces.append(chain[::-1])
    return np.array(points), faces


def assert_closed(faces):
    sides = half_edges(faces)
    assert all(count == 1 and (b, a) in sides for (a, b), count in sides.items())


@pytest.mark.parametrize("seed", range(40))
def test_faces_without_area_leave_no_gap(seed):
    points, faces = with_caps(seed)
    assert_closed(faces)
    result = df.fair(points, faces, 1, repair="mend")
    now = mended_faces(result)
    assert_closed(now)
    assert [d for d in df.check(points, now) if d.code != "ISOLATED_VERTICES"] == []
    assert [r["code"] for r in result.report["repairs"]] == ["DEGENERATE_FACE"]
    assert np.array_equal(result.vertices[: len(points)], points)
    codes = {warning["code"] for warning in result.report["warnings"]}
    assert codes <= {"THICKNESS_CHANGED"}, "every vertex is still a corner"
    m = result.mended
    corners = np.concatenate(faces)
    at = points[corners[m.corner_origin]]
    mixed = at[:, 0] + m.corner_share[:, None] * (at[:, 1] - at[:, 0])
    assert np.allclose(mixed, points[m.corners], rtol=0, atol=1e-12)
    face = np.repeat(np.arange(len(faces)), [len(f) for f in faces])
    own = np.repeat(m.face_origin, np.diff(m.offsets))
    assert (face[m.corner_origin] == own[:, None]).all()


def damaged(seed):
    """A mesh with defects of all kinds that can be mended, and with sheets that meet."""
    random = np.random.default_rng(seed)
    points, faces = with_caps(seed, edges=int(random.integers(0, 5)))
    for _ in range(random.integers(1, 8)):
        f = int(random.integers(len(faces)))
        face = faces[f]
        match random.integers(9):
            case 0:
                faces.append(np.roll(face, 1).tolist())
            case 1:
                faces.append(face[::-1])
            case 2:
                faces[f] = face[::-1]
            case 3:
                points[face[0]] = points[face[1]]
            case 4:
                faces[f] = [face[0], *face]
            case 5:
                faces[f] = [face[0], face[1], face[0], *face[2:]]
            case 6:
                there = np.flatnonzero(np.isfinite(points).all(1))
                faces.append(random.choice(there, int(random.integers(3, 7))).tolist())
            case 7:
                faces.append(face[:2])
            case 8:
                points = np.concatenate([points, points[face[:1]], [[np.nan, 0, 0]]])
                faces[f] = [len(points) - 2, *face[1:]]
    if random.integers(4) == 0:
        faces[0] = [*faces[0][:-1], len(points)]
    return points, faces


def mended(points, faces, **options):
    """The result; None where a defect remains that mending leaves to others."""
    try:
        result = df.fair(points, faces, 0, repair="mend", **options)
    except df.FairingError as error:
        assert error.code in LEFT, str(error)
        return None
    return result


@pytest.mark.parametrize("seed", range(150))
@pytest.mark.parametrize("weld", [None, 0, 0.05])
def test_what_is_left_is_sound(seed, weld):
    points, faces = damaged(seed)
    result = mended(points, faces, weld=weld)
    if result is None:
        return
    now = faces if result.mended is None else mended_faces(result)
    places = np.nan_to_num(points)
    codes = {d.code for d in df.check(places, now) if d.severity == "error"}
    assert codes <= {"INCONSISTENT_ORIENTATION"} and np.isfinite(result.vertices).all()
    if result.mended is not None:
        used = np.unique(np.concatenate(now))
        assert np.array_equal(result.mended.vertex_origin[used], used)
    again = df.fair(places, now, 0, repair="mend", weld=weld)
    assert again.mended is None, "nothing is left to mend"


@pytest.mark.parametrize("seed", range(150))
def test_the_order_of_faces_and_corners_decides_nothing(seed):
    points, faces = damaged(seed)
    random = np.random.default_rng(seed)
    order = random.permutation(len(faces))
    other = [np.roll(faces[f], random.integers(4)).tolist() for f in order]
    results = [mended(points, f) for f in (faces, other)]
    assert (results[0] is None) == (results[1] is None)
    if results[0] is not None:
        now = [
            f if r.mended is None else mended_faces(r)
            for r, f in zip(results, (faces, other), strict=True)
        ]
        one, two = (sorted(tuple(sorted(face)) for face in each) for each in now)
        assert one == two
