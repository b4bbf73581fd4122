# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings that no call can use: refused by a code, in words that name them, and with the elements."""

from functools import partial

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from piece_meshes import torus
from ragged_holes import quads_with_a_hole
from scans import blob_cage, blob_scan
from test_neighbour import bonnet_and_fender
from test_soft_creases import roof

NAN, INF = float("nan"), float("inf")
OPTION, SHAPE, RANGE = "BAD_OPTION", "BAD_SHAPE", "INDEX_OUT_OF_RANGE"
CUBE, BALL, PLATE = meshes.cube(), meshes.icosahedron(), meshes.grid(6, 6)
FIXED, OTHER = bonnet_and_fender()
HOLED = quads_with_a_hole()
RIM = min(df.find_holes(*HOLED), key=len).tolist()
CAGE, SCAN = blob_cage(6, off=0.02), blob_scan(500)
TILTED = np.where(np.arange(49)[:, None] == 24, [1.0, 0, 1], NAN)
THREE = np.zeros((3, 3))

# name: call, [(settings, code, what the message has)]
REFUSED = {
    "region": (
        partial(df.fair, *BALL, 1),
        [
            ({"region": []}, OPTION, ""),
            ({"region": [0, 20, -1]}, RANGE, [20, -1]),
            ({"region": [0.5]}, SHAPE, ""),
            ({"region": [[0, 1]]}, SHAPE, ""),
        ],
    ),
    "normals": (
        partial(df.fair, *PLATE, 2),
        [
            ({"normals": TILTED, "energy": "total_curvature"}, OPTION, "thin plate"),
            ({"normals": TILTED, "energy": "minimum_variation"}, OPTION, "thin plate"),
            ({"normals": TILTED, "method": "back_leg"}, OPTION, "multigrid"),
            ({"normals": THREE}, OPTION, ""),
            ({"normals": np.zeros(147)}, SHAPE, ""),
            ({"normals": np.zeros((49, 2))}, SHAPE, ""),
            ({"normals": np.full((49, 3), INF)}, OPTION, ""),
            ({"normals": "up"}, SHAPE, ""),
        ],
    ),
    "flat faces": (
        partial(df.fair, *BALL, 1),
        [
            ({"flat_faces": [0], "energy": "total_curvature"}, OPTION, "thin plate"),
            ({"flat_faces": [0], "energy": "minimum_variation"}, OPTION, "thin plate"),
        ],
    ),
    "shapes": (
        partial(df.fair, *BALL, 1),
        [
            ({"shapes": np.zeros((12, 3))}, SHAPE, ""),
            ({"shapes": np.zeros((1, 11, 3))}, SHAPE, ""),
            ({"shapes": [np.zeros((12, 3)), np.zeros((5, 3))]}, SHAPE, ""),
            ({"shapes": 7}, SHAPE, ""),
            ({"shapes": "ab"}, SHAPE, ""),
            (
                {"shapes": [BALL[0], np.where(BALL[0] == BALL[0][3], NAN, BALL[0])]},
                "NON_FINITE",
                "1",
            ),
        ],
    ),
    "border edges": (
        partial(df.fair, *meshes.wavy_patch(), 1),
        [
            ({"boundary_edges": edges, "symmetry_plane": plane}, code, "")
            for plane in (None, "y")
            for edges, code in (
                ([(0, 1)], OPTION),
                ("free", OPTION),
                ({"smooth": [(0, 1)]}, OPTION),
                ({"free": [(0, 1, 2)]}, SHAPE),
                ({"free": [(0.0, 1.0)]}, SHAPE),
                ({"free": [(0, 12)]}, "BAD_FEATURE_EDGE"),
                ({"linear": [(0, 25)]}, RANGE),
            )
        ],
    ),
    "soft creases": (
        partial(df.fair, *roof()),
        [
            ({"soft_creases": ([[4, 13]], [1.5])}, OPTION, "soft_creases must be from 0 to 1"),
            ({"soft_creases": ([[4, 13]], [-0.5])}, OPTION, "soft_creases must be from 0 to 1"),
            ({"soft_creases": ([[4, 14]], 0.5)}, "BAD_FEATURE_EDGE", "no edge"),
            ({"soft_creases": ([[4, 999]], 0.5)}, RANGE, [999]),
            ({"soft_creases": ([[4, 13]], [0.5, 0.5])}, SHAPE, "soft_creases"),
        ],
    ),
    "limit": (
        partial(df.fair, *meshes.HOUSE, 1, interpolation="limit"),
        [
            ({"limit": 1.5}, OPTION, "limit is 1.5"),
            ({"weights": np.ones(10)}, OPTION, "weights"),
            ({"edge_sharpness": ([[4, 5]], [-1.0])}, OPTION, "edge_sharpness must be zero"),
            ({"edge_sharpness": ([[4, 99]], 1.0)}, RANGE, "99"),
            ({"edge_sharpness": ([[4, 5]], [1.0, 2.0])}, SHAPE, "edge_sharpness"),
            ({"edge_sharpness": 3}, OPTION, "edge_sharpness"),
            ({"vertex_sharpness": [1.0, 2.0]}, OPTION, "vertex_sharpness"),
        ],
    ),
    "neighbour": (
        lambda **more: df.fair(*OTHER, **{"levels": 2, "neighbour": FIXED} | more),
        [
            ({"region": [0]}, OPTION, ""),
            ({"border": [(0, 5)]}, OPTION, ""),
            ({"levels": 1}, OPTION, ""),
            ({"shapes": [OTHER[0]]}, OPTION, ""),
            ({"neighbour": (FIXED[0] + [0, 5, 0], FIXED[1])}, OPTION, "No border edge meets"),
        ],
    ),
    "pieces": (
        partial(df.pieces, *torus(), 2),
        [
            ({"symmetry_plane": "x", "count": 3}, OPTION, "symmetry_plane "),
            ({"measure": True, "count": 3}, OPTION, "measure "),
            ({"threads": 2, "count": 3}, OPTION, "threads "),
            ({"memory_limit": 10**9, "count": 3}, OPTION, "memory_limit "),
            ({"progress": print, "count": 3}, OPTION, "progress "),
            ({"monitor": df.Monitor(), "count": 3}, OPTION, "monitor "),
            ({"count": 0}, OPTION, "count is 0"),
            ({"count": 3, "crease_edges": [(0, 200)]}, "BAD_FEATURE_EDGE", "no edge"),
        ],
    ),
    "weld": (
        partial(df.fair, *BALL, 1),
        [
            ({"weld": 0}, OPTION, "weld"),
            ({"weld": -1, "repair": "mend"}, OPTION, "weld"),
            ({"weld": "far", "repair": "mend"}, OPTION, "weld"),
        ],
    ),
    "strain": (
        partial(df.strain, *CUBE),
        [
            ({"energy": "minimum_variation"}, OPTION, "no pads"),
            ({"energy": "total_curvature"}, OPTION, "thin plate"),
            ({"interpolation": "approximate", "tolerance": 0.1}, OPTION, "exact"),
            ({"pad_size": 0.0}, OPTION, "pads"),
        ],
    ),
    "ease": (
        partial(df.ease, *CUBE),
        [
            ({"tolerance": -1.0}, OPTION, "length"),
            ({"tolerance": [1.0, 2.0]}, OPTION, "length"),
            ({"most": 0}, OPTION, "1 or more"),
            ({"most": 1, "tolerance": 1.0}, OPTION, "exclude"),
            ({"fixed": [True]}, OPTION, "bools"),
            ({"energy": "minimum_variation"}, OPTION, "no pads"),
        ],
    ),
    "clean": (
        partial(df.clean, *BALL),
        [
            ({"islands": 2.0}, OPTION, ""),
            ({"largest": -1.0}, OPTION, ""),
            ({"noise": 1001}, OPTION, ""),
            ({"noise": 1.5}, OPTION, ""),
            ({"noise": "much"}, OPTION, ""),
            ({"fixed": [True]}, SHAPE, ""),
            ({"progress": 1}, OPTION, ""),
        ],
    ),
    "denoise": (
        lambda faces=BALL[1], **more: df.denoise(BALL[0], faces, **more),
        [
            ({"passes": -1}, OPTION, ""),
            ({"passes": 1001}, OPTION, ""),
            ({"passes": 1, "amount": 1.0}, OPTION, ""),
            ({"amount": 0.0}, OPTION, ""),
            ({"amount": NAN}, OPTION, ""),
            ({"amount": "much"}, OPTION, ""),
            ({"fixed": [True]}, OPTION, ""),
            ({"faces": BALL[1] + 100}, RANGE, ""),
        ],
    ),
    "fill_holes": (
        partial(df.fill_holes, *HOLED),
        [
            ({"holes": [RIM[:2]]}, OPTION, ""),
            ({"holes": [[0, 1, 10**6]]}, RANGE, [10**6]),
            ({"joint": "loose"}, OPTION, ""),
            ({"density": -1}, OPTION, ""),
            ({"energy": "none"}, OPTION, ""),
            ({"rim": "rough"}, OPTION, ""),
            ({"quads": 1}, OPTION, "quads is 1"),
        ],
    ),
    "fit_patches": (
        partial(df.fit_patches, *CUBE),
        [
            ({"tolerance": 0}, OPTION, ""),
            ({"normal_tolerance": -1}, OPTION, ""),
            ({"levels": 1}, OPTION, ""),
        ],
    ),
    "fit": (
        lambda points=SCAN, **more: df.fit(*CAGE, points, **more),
        [
            ({"tolerance": -1.0}, OPTION, "tolerance"),
            ({"weight": 0.0}, OPTION, "weight"),
            ({"weight": 1.0, "tolerance": 1.0}, OPTION, "exclude"),
            ({"energy": "total_curvature"}, OPTION, "thin_plate"),
            ({"interpolation": "limit"}, OPTION, "interpolation"),
            ({"fixed": [0, 1]}, OPTION, "fixed"),
            ({"pad_size": 1.0}, OPTION, "no pads"),
            ({"triangles": [[0, 1, 99_999]]}, RANGE, "99999"),
            ({"normals": THREE}, SHAPE, "normal"),
            ({"points": np.empty((0, 3))}, SHAPE, "no points"),
            ({"points": THREE[:1] + [0, 0, 0.8]}, SHAPE, "1 point"),
            ({"points": np.array([[0, 0, 1.0]] * 20 + [[0, NAN, 0]])}, "NON_FINITE", "Point 20"),
            ({"points": 1000 * SCAN}, SHAPE, "units"),
            ({"points": SCAN / 1000}, SHAPE, "units"),
            ({"points": SCAN + [9, 0, 0]}, SHAPE, "Move"),
            ({"points": np.zeros((5, 2))}, SHAPE, "(S, 3)"),
        ],
    ),
}


@pytest.mark.parametrize(
    "name, settings, code, has",
    [(name, *case) for name, (_, cases) in REFUSED.items() for case in cases],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else None,
)
def test_what_is_refused(name, settings, code, has):
    with pytest.raises(df.FairingError) as caught:
        REFUSED[name][0](**settings)
    error = caught.value
    assert error.code == code
    assert error.elements == has if isinstance(has, list) else has in str(error)
