# SPDX-License-Identifier: GPL-3.0-or-later
"""What objects and meshes remember is out of sight, and stays in files."""

import bpy
import pytest
from scenes import CUBE, add, fair

from addon import memory


def custom_properties(owner):
    """Those that the panel Custom Properties lists."""
    return set(owner.keys()) - set(owner.bl_rna.properties.keys())


def test_nothing_is_in_sight():
    add("Box", *CUBE)
    target = fair(levels=1)
    bpy.ops.object.fairing_inspect(mode="MEAN")
    bpy.ops.object.fairing_measure()
    bpy.ops.object.fairing_check()
    for name in ("report", "readout", "defects"):
        assert memory.recall(target, name) is not None
    assert not custom_properties(target) and not custom_properties(target.data)


@pytest.mark.parametrize("text", ["", "no JSON", "3", "[1]"])
def test_what_cannot_be_read_is_nothing(text):
    target = add("Box", *CUBE)
    target.discrete_fairing.report = text
    assert memory.recall(target, "report") is None
