# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings that no call can use: refused by a code, in words that name them, and with the elements."""

from functools import partial

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from piece_meshes import torus
from ragged_holes import quads_with_a_hole
from refusing import refusal
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


def each(code, has="", /, **values):
    """A case of one setting for each of its values."""
    return [({name: value}, code, has) for name, given in values.items() for value in given]


# name: call, [(settings, code, what the message has)]
REFUSED = {
    "region": (
        partial(df.fair, *BALL, 1),
        [
            *each(OPTION, region=[[]]),
            *each(RANGE, [20, -1], region=[[0, 20, -1]]),
            *each(SHAPE, region=[[0.5], [[0, 1]]]),
        ],
    ),
    "normals": (
        partial(df.fair, *PLATE, 2),
        [
            ({"normals": TILTED, "energy": "total_curvature"}, OPTION, "thin plate"),
            ({"normals": TILTED, "energy": "minimum_variation"}, OPTION, "thin plate"),
            ({"normals": TILTED, "method": "back_leg"}, OPTION, "multigrid"),
            *each(OPTION, normals=[THREE, np.full((49, 3), INF)]),
            *each(SHAPE, normals=[np.zeros(147), np.zeros((49, 2)), "up"]),
        ],
    ),
    "flat faces": (
        partial(df.fair, *BALL, 1, flat_faces=[0]),
        [
            *each(OPTION, "thin plate", energy=["total_curvature", "minimum_variation"]),
            ({"interpolation": "limit"}, OPTION, "limit positions"),
        ],
    ),
    "shapes": (
        partial(df.fair, *BALL, 1),
        [
            *each(SHAPE, shapes=[np.zeros((12, 3)), np.zeros((1, 11, 3)), 7, "ab"]),
            *each(SHAPE, shapes=[[np.zeros((12, 3)), np.zeros((5, 3))]]),
            *each("NON_FINITE", "1", shapes=[[BALL[0], np.where(BALL[0] == BALL[0][3], NAN, 1.0)]]),
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
            *each(OPTION, "from 0 to 1", soft_creases=[([[4, 13]], [w]) for w in (1.5, -0.5)]),
            *each("BAD_FEATURE_EDGE", "no edge", soft_creases=[([[4, 14]], 0.5)]),
            *each(RANGE, [999], soft_creases=[([[4, 999]], 0.5)]),
            *each(SHAPE, "soft_creases", soft_creases=[([[4, 13]], [0.5, 0.5])]),
        ],
    ),
    "limit": (
        partial(df.fair, *meshes.HOUSE, 1, interpolation="limit"),
        [
            *each(OPTION, "limit is 1.5", limit=[1.5]),
            *each(OPTION, "weights", weights=[np.ones(10)]),
            *each(OPTION, "edge_sharpness", edge_sharpness=[([[4, 5]], [-1.0]), 3]),
            *each(RANGE, "99", edge_sharpness=[([[4, 99]], 1.0)]),
            *each(SHAPE, "edge_sharpness", edge_sharpness=[([[4, 5]], [1.0, 2.0])]),
            *each(OPTION, "vertex_sharpness", vertex_sharpness=[[1.0, 2.0]]),
        ],
    ),
    "neighbour": (
        lambda **more: df.fair(*OTHER, **{"levels": 2, "neighbour": FIXED} | more),
        [
            *each(OPTION, region=[[0]], border=[[(0, 5)]], levels=[1], shapes=[[OTHER[0]]]),
            *each(OPTION, "No border edge meets", neighbour=[(FIXED[0] + [0, 5, 0], FIXED[1])]),
        ],
    ),
    "pieces": (
        lambda **more: df.pieces(*torus(), 2, **{"count": 3} | more),
        [
            *each(OPTION, "symmetry_plane ", symmetry_plane=["x"]),
            *each(OPTION, "measure ", measure=[True]),
            *each(OPTION, "threads ", threads=[2]),
            *each(OPTION, "memory_limit ", memory_limit=[10**9]),
            *each(OPTION, "progress ", progress=[print]),
            *each(OPTION, "monitor ", monitor=[df.Monitor()]),
            *each(OPTION, "count is 0", count=[0]),
            *each("BAD_FEATURE_EDGE", "no edge", crease_edges=[[(0, 200)]]),
        ],
    ),
    "weld": (partial(df.fair, *BALL, 1), each(OPTION, "weld", weld=[0])),
    "weld and mend": (
        partial(df.fair, *BALL, 1, repair="mend"),
        each(OPTION, "weld", weld=[-1, "far"]),
    ),
    "strain": (
        partial(df.strain, *CUBE),
        [
            *each(OPTION, "no pads", energy=["minimum_variation"]),
            *each(OPTION, "thin plate", energy=["total_curvature"]),
            ({"interpolation": "approximate", "tolerance": 0.1}, OPTION, "exact"),
            *each(OPTION, "pads", pad_size=[0.0]),
        ],
    ),
    "ease": (
        partial(df.ease, *CUBE),
        [
            *each(OPTION, "length", tolerance=[-1.0, [1.0, 2.0]]),
            *each(OPTION, "1 or more", most=[0]),
            ({"most": 1, "tolerance": 1.0}, OPTION, "exclude"),
            *each(OPTION, "bools", fixed=[[True]]),
            *each(OPTION, "no pads", energy=["minimum_variation"]),
        ],
    ),
    "clean": (
        partial(df.clean, *BALL),
        each(OPTION, islands=[2.0], largest=[-1.0], progress=[1], fixed=[[True]]),
    ),
    "denoise": (
        lambda faces=BALL[1], **more: df.denoise(BALL[0], faces, **more),
        [
            *each(OPTION, amount=[0.0, NAN, "much"], fixed=[[True]]),
            *each(RANGE, faces=[BALL[1] + 100]),
        ],
    ),
    "fill_holes": (
        partial(df.fill_holes, *HOLED),
        [
            *each(OPTION, holes=[[RIM[:2]]], joint=["loose"], density=[-1], energy=["none"]),
            *each(OPTION, rim=["rough"]),
            *each(RANGE, [10**6], holes=[[[0, 1, 10**6]]]),
        ],
    ),
    "fit_patches": (
        partial(df.fit_patches, *CUBE),
        each(OPTION, tolerance=[0], normal_tolerance=[-1], levels=[1]),
    ),
    "fit": (
        lambda points=SCAN, **more: df.fit(*CAGE, points, **more),
        [
            *each(OPTION, "tolerance", tolerance=[-1.0]),
            *each(OPTION, "weight", weight=[0.0]),
            ({"weight": 1.0, "tolerance": 1.0}, OPTION, "exclude"),
            *each(OPTION, "thin_plate", energy=["total_curvature"]),
            *each(OPTION, "interpolation", interpolation=["limit"]),
            *each(OPTION, "fixed", fixed=[[0, 1]]),
            *each(OPTION, "no pads", pad_size=[1.0]),
            *each(RANGE, "99999", triangles=[[[0, 1, 99_999]]]),
            *each(SHAPE, "normal", normals=[THREE]),
            *each(SHAPE, "no points", points=[np.empty((0, 3))]),
            *each(SHAPE, "1 point", points=[THREE[:1] + [0, 0, 0.8]]),
            *each("NON_FINITE", "Point 20", points=[[[0, 0, 1.0]] * 20 + [[0, NAN, 0]]]),
            *each(SHAPE, "units", points=[1000 * SCAN, SCAN / 1000]),
            *each(SHAPE, "Move", points=[SCAN + [9, 0, 0]]),
            *each(SHAPE, "(n, 3)", points=[np.zeros((5, 2))]),
        ],
    ),
}


@pytest.mark.parametrize(
    "name, settings, code, has",
    [(name, *case) for name, (_, cases) in REFUSED.items() for case in cases],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else None,
)
def test_what_is_refused(name, settings, code, has):
    error = refusal(REFUSED[name][0], **settings)
    assert error.code == code
    assert error.elements == has if isinstance(has, list) else has in str(error)
