# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings arrive at the core under its own names."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from scenes import CUBE, add, set_edge_attribute

from addon import native
from addon.preferences import Defaults
from addon.read.mesh import read_mesh
from addon.request.arguments import fair_arguments
from addon.settings.properties import DEFAULT_ENERGY, ENERGIES, NAMES


def settings(**changes):
    """The defaults as the panel has them, with some changed."""
    scene = bpy.context.scene.discrete_fairing
    return SimpleNamespace(**{**{name: getattr(scene, name) for name in NAMES}, **changes})


def arguments(mesh=None, **changes):
    return fair_arguments(read_mesh(mesh or add("Box", *CUBE).data), settings(**changes), Defaults)


def test_defaults():
    given = arguments()
    assert (given["levels"], given["energy"], given["interpolation"], given["boundary"]) == (
        3,
        DEFAULT_ENERGY.lower(),
        "exact",
        "curve",
    )
    assert given["metric_exponent"] == 0.5 and given["epsilon"] == 0.0 and given["tolerance"] == 0.0
    assert given["crease_angle"] is None and given["corner_angle"] is None
    assert given["crease_edges"].shape == (0, 2) and given["corner_vertices"].shape == (0,)


def test_values():
    given = arguments(
        levels=5, interpolation="APPROXIMATE", tolerance=0.25, boundary="FREE", metric_exponent=1.0, epsilon=0.125,
        use_crease_angle=True, crease_angle=1.0, use_corner_angle=True, corner_angle=2.0, repair_orientation=True, memory_limit=3,
    )  # fmt: skip
    assert given["levels"] == 5 and given["interpolation"] == "approximate" and given["tolerance"] == 0.25
    assert given["boundary"] == "free" and given["metric_exponent"] == 1.0 and given["epsilon"] == 0.125
    assert given["crease_angle"] == 1.0 and given["corner_angle"] == 2.0
    assert given["repair_orientation"] and given["memory_limit"] == 3 * 2**20


@pytest.mark.parametrize("energy", [key for key, *_ in ENERGIES])
def test_energies_are_those_of_the_core(energy):
    given = arguments(energy=energy)["energy"]
    assert given in native.core()._native.Energy.__members__ and given.upper() == energy


def test_tolerance_belongs_to_approximation():
    assert arguments(interpolation="EXACT", tolerance=0.25)["tolerance"] == 0.0


@pytest.mark.parametrize(
    "name, data_type, value, changes",
    [
        ("crease_edge", "FLOAT", 1.0, {}),
        ("crease_edge", "FLOAT", 0.3, {"crease_threshold": 0.3}),
        ("sharp_edge", "BOOLEAN", True, {"use_sharp_edges": True}),
    ],
)
def test_creases_from_the_mesh(name, data_type, value, changes):
    mesh = add("Box", *CUBE).data
    set_edge_attribute(mesh, name, data_type, [(0, 1), (3, 7)], value)
    assert {tuple(sorted(pair)) for pair in arguments(mesh, **changes)["crease_edges"].tolist()} == {
        (0, 1),
        (3, 7),
    }


@pytest.mark.parametrize(
    "name, data_type, value, changes",
    [
        ("crease_edge", "FLOAT", 1.0, {"use_crease_attribute": False}),
        ("crease_edge", "FLOAT", 0.25, {}),
        ("sharp_edge", "BOOLEAN", True, {}),
    ],
)
def test_creases_that_were_not_asked_for(name, data_type, value, changes):
    mesh = add("Box", *CUBE).data
    set_edge_attribute(mesh, name, data_type, [(0, 1)], value)
    assert len(arguments(mesh, **changes)["crease_edges"]) == 0


def test_arrays_are_flat_and_whole():
    given = arguments()
    corners, offsets = given["faces"]
    assert corners.dtype == offsets.dtype == np.int32 and given["vertices"].dtype == np.float64
    assert given["vertices"].flags["C_CONTIGUOUS"]
