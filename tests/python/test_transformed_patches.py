# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches at another place: the same surfaces, looking outward in a mirror too."""

import discrete_fairing as df
import numpy as np

BOX = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
OPEN = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4)]


def corner_normals(patches):
    """(P, 3) at u = v = 0."""
    nets = [patches.net(p) for p in range(len(patches))]
    return np.array([np.cross(net[1, 0] - net[0, 0], net[0, 1] - net[0, 0]) for net in nets])


def loops_start_at_the_corner(patches):
    for p in range(len(patches)):
        at = patches.net(p)[0, 0]
        for edge, forward in patches.loop(p):
            ends = patches.edge(edge)[[0, -1] if forward else [-1, 0]]
            assert np.allclose(ends[0], at, atol=1e-12)
            at = ends[1]
        assert np.allclose(at, patches.net(p)[0, 0], atol=1e-12)


def test_patches_move_with_all_that_they_have():
    patches = df.fit_patches(BOX, OPEN, levels=5)
    matrix = np.array([[0, -2, 0, 5], [2, 0, 0, 1], [0, 0, 2, 0], [0, 0, 0, 1]], float)
    moved = patches.transformed(matrix)
    for name in ("vertices", "edge_points", "patch_points"):
        wanted = getattr(patches, name) @ matrix[:3, :3].T + (5, 1, 0)
        assert np.allclose(getattr(moved, name), wanted, atol=1e-12)
    loops_start_at_the_corner(moved)
    assert (moved.loop_edges == patches.loop_edges).all()


def test_a_mirrored_open_shell_still_looks_outward():
    patches = df.fit_patches(BOX, OPEN, levels=5)
    before = patches.patch_points.copy()
    mirrored = patches.transformed(np.diag([-1.0, 1, 1, 1]))
    loops_start_at_the_corner(mirrored)
    wanted = corner_normals(patches) * (-1, 1, 1)
    assert np.allclose(corner_normals(mirrored), wanted, atol=1e-12)
    assert (patches.patch_points == before).all()
