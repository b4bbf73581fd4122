# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces meant to be flat stay flat beside tight rims, and the rest blends into them."""

import discrete_fairing as df
import flat_parts
import numpy as np
import pytest
from catmull_clark import subdivide

LEVEL = 3


def flatness(part, points, faces, owner):
    """(how far flat faces are off their planes as a share of the size, their largest turn in degrees).

    `faces`: lists of arrays (k, 3 | 4), `owner`: of each, the control face of every one."""
    vertices, polygons, flat, _ = part
    off = turn = 0.0
    for refined, of in zip(faces, owner):
        for f in flat:
            own = points[refined[of == f]]
            if not len(own):
                continue
            a, b, c = vertices[polygons[f][:3]]
            normal = np.cross(b - a, c - a)
            normal /= np.linalg.norm(normal)
            off = max(off, np.abs((own - a) @ normal).max())
            first, second = own[:, 2] - own[:, 0], own[:, -1] - own[:, 1]
            across = np.cross(first, second)
            across /= np.linalg.norm(across, axis=1)[:, None]
            turn = max(turn, np.degrees(np.arccos(np.clip(np.abs(across @ normal), 0, 1))).max())
    return off / np.ptp(vertices, axis=0).max(), turn


def of_result(part, found):
    return flatness(part, found.vertices, found.faces, (found.triangle_polygon, found.quad_polygon))


def of_subdivision(part):
    points, faces, owner = part[0], part[1], np.arange(len(part[1]))
    for _ in range(LEVEL):
        owner = np.repeat(owner, [len(face) for face in faces])
        points, faces = subdivide(points, faces)[:2]
    return flatness(part, points, [np.array(faces)], [owner])


@pytest.mark.parametrize("name", flat_parts.PARTS)
@pytest.mark.parametrize("size", range(3))
def test_flat_faces_are_flat_and_nearer_than_subdivision_surface(name, size):
    make, sizes = flat_parts.PARTS[name]
    part = make(*sizes[size])
    found = df.fair(part[0], part[1], LEVEL, flat_faces=part[2])
    assert np.array_equal(found.vertices[: len(part[0])], part[0])
    off, turn = of_result(part, found)
    beside = of_subdivision(part)
    assert off < 1e-4 and turn < 0.1 * beside[1]
    assert of_result(part, df.fair(part[0], part[1], LEVEL))[0] > 2e-3


def test_other_calls_know_flat_faces():
    points, faces, flat, _ = flat_parts.rounded_box(90, 60, 30, 4)
    found = df.fair(points, faces, 2, flat_faces=flat).vertices
    assert (
        np.abs(df.Solver(points, faces, 2, flat_faces=flat).solve(points).vertices - found).max()
        < 1e-2
    )
    parts = [piece.fair() for piece in df.pieces(points, faces, 2, count=2, flat_faces=flat)]
    assert np.abs(df.join(parts).vertices - found).max() < 1e-2
    twice = [*faces, faces[0]]
    assert (
        np.abs(df.fair(points, twice, 2, repair="mend", flat_faces=flat).vertices - found).max()
        < 1e-9
    )
    with pytest.raises(df.FairingError, match="flat_faces"):
        df.fair(points, faces, flat_faces=[len(faces)])
