# SPDX-License-Identifier: GPL-3.0-or-later
"""Strained vertices in a row are a knuckle that wants a crease, not wrong offsets."""

import bpy
import hulls
import numpy as np
import pytest
from scenes import EXAMPLES, computed, positions, refused, to_object_mode

from addon.mesh.offset_names import read_names
from addon.mesh.shape_keys import EASED, key_positions
from addon.strain.measure import StrainJob


def chine(without, truth=False):
    """The hull with a chine, whose crease is missing at edges of the stations `without`."""
    bpy.ops.import_mesh.fairing_offsets(filepath=str(EXAMPLES / "offsets_chine.csv"))
    hull = bpy.context.active_object
    names, layer = read_names(hull.data), hull.data.attributes["crease_edge"].data
    ends = {f"station {k}, Chine" for k in without}
    for edge in hull.data.edges:
        both = {names[v] for v in edge.vertices}
        if all("Chine" in name for name in both) and ends & both:
            layer[edge.index].value = 0.0
    if truth:
        places = np.array(list(hulls.chine().points.values())) / 1000.0
        hull.data.vertices.foreach_set("co", places.astype(np.float32).ravel())
    return hull


def found(hull):
    job = computed(StrainJob(bpy.context, hull))
    return [job.result.name(v) for v in job.result.knuckle]


@pytest.mark.parametrize(
    "without, truth, stations",
    [
        ([], True, []),
        ([7, 8], True, [6, 7, 8]),
        ([7, 8], False, [6, 7, 8]),
        ([0, 1, 2], True, [0, 1, 2, 3]),
        ([0, 1, 2], False, [0, 1, 2, 3]),
        (range(9), True, range(9)),
        (range(9), False, range(9)),  # not in the order of their strain
    ],
)
def test_a_chain_of_one_sign_is_a_knuckle(without, truth, stations):
    assert found(chine(without, truth)) == [f"station {k}, Chine" for k in stations]


@pytest.mark.parametrize(
    "file", ["offsets_bulb.csv", "offsets_chine.csv", "offsets_yacht.tsv", "offsets.csv"]
)
def test_wrong_offsets_are_none(file):
    bpy.ops.import_mesh.fairing_offsets(filepath=str(EXAMPLES / file))
    assert found(bpy.context.active_object) == []


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_one_click_creases_it(mode):
    hull = chine([7, 8])
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.object.fairing_crease_knuckle() == {"FINISHED"}
    to_object_mode()
    values = [item.value for item in hull.data.attributes["crease_edge"].data]
    assert values.count(1.0) == 20 and found(hull) == []
    refused("no strained vertices form a chain", bpy.ops.object.fairing_crease_knuckle)


def test_worst_vertices_leave_it_alone():
    """It once moved by 130 mm."""
    hull = chine([7, 8])
    before, names = positions(hull.data), read_names(hull.data)
    assert bpy.ops.object.fairing_ease(amount="WORST", count=3) == {"FINISHED"}
    eased = key_positions(hull, EASED, len(before))
    moved = np.linalg.norm(eased - before, axis=1)
    assert np.count_nonzero(moved) == 3 and not moved[names.index("station 7, Chine")]
