# SPDX-License-Identifier: GPL-3.0-or-later
"""What objects and meshes remember is out of sight, and comes over from older files."""

import json

import bpy
import pytest
from scenes import CUBE, add, fair

from addon import memory
from addon.inspection import display

RECORDS = {
    "fairing_report": ("report", {"energy": {"result": {"thin_plate": 1.5}}}),
    "fairing_readout": ("readout", {"after": {"faces": 6}, "before": None, "counts": [8, 12, 6]}),
    "fairing_check": ("defects", {"defects": [], "counts": [8, 12, 6]}),
}


def custom_properties(owner):
    """Those that the panel Custom Properties lists."""
    return set(owner.keys()) - set(owner.bl_rna.properties.keys())


def make_old(target):
    """Gives an object, its mesh and the scene the custom properties of an older file."""
    for old, (_, record) in RECORDS.items():
        target[old] = json.dumps(record)
    target.data["fairing_curvature_range"] = "[-2.5, 2.5]"
    target.data["fairing_active_colour"] = "Mine"
    for group in (target.discrete_fairing, bpy.context.scene.discrete_fairing):
        group["epsilon"] = group["vertex_release"] = 0.25
        group["interpolation"], group["tolerance"] = 1, 0.125


def check_settings(group):
    for gone in ("epsilon", "vertex_release"):
        assert group.get(gone) is None
    assert (group.interpolation, group.tolerance) == ("APPROXIMATE", 0.125)
    assert group.tolerance_unit == "SCENE"


def check_taken_over(target):
    for name, record in RECORDS.values():
        assert memory.recall(target, name) == record
    assert display.legend(target.data) == (-2.5, 2.5)
    assert target.data.discrete_fairing.active_colour == "Mine"
    check_settings(target.discrete_fairing)
    assert target.discrete_fairing.pad_size == 0.0, "as it was made"
    assert not custom_properties(target) and not custom_properties(target.data)


@pytest.fixture
def old_file(tmp_path):
    make_old(add("Box", *CUBE))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "old.blend"))
    assert custom_properties(bpy.data.objects["Box"])
    return str(tmp_path / "old.blend")


def test_an_older_file_is_taken_over(old_file):
    bpy.ops.wm.open_mainfile(filepath=old_file)
    check_taken_over(bpy.data.objects["Box"])
    check_settings(bpy.context.scene.discrete_fairing)
    assert bpy.context.scene.discrete_fairing.pad_size == 1.0, "for new surfaces"


def test_objects_appended_from_an_older_file_are_taken_over(old_file):
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(old_file) as (_, wanted):
        wanted.objects = ["Box"]
    check_taken_over(wanted.objects[0])


def test_objects_linked_from_an_older_file_stay_as_they_are(old_file):
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(old_file, link=True) as (_, wanted):
        wanted.objects = ["Box"]
    assert memory.recall(wanted.objects[0], "report") is None
    assert custom_properties(wanted.objects[0]) == set(RECORDS)


def test_newer_settings_stay(tmp_path):
    add("Box", *CUBE)
    result = fair(levels=1, interpolation="APPROXIMATE", relative_tolerance=0.25)
    bpy.context.scene.discrete_fairing.interpolation = "APPROXIMATE"
    name = result.name
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "new.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "new.blend"))
    kept = bpy.data.objects[name].discrete_fairing
    assert (kept.tolerance_unit, kept.relative_tolerance) == ("RELATIVE", 0.25)
    assert kept.pad_size == 1.0
    assert bpy.context.scene.discrete_fairing.tolerance_unit == "RELATIVE"


def test_what_is_newer_stays():
    target = add("Box", *CUBE)
    memory.keep(target, "report", {"newer": True})
    target["fairing_report"] = "{}"
    memory.take_over_old_properties()
    assert memory.recall(target, "report") == {"newer": True} and not custom_properties(target)


def test_a_user_s_own_property_of_that_name_stays():
    target = add("Box", *CUBE)
    target["fairing_report"] = 3
    memory.take_over_old_properties()
    assert target["fairing_report"] == 3


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
