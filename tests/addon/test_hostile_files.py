# SPDX-License-Identifier: GPL-3.0-or-later
"""A file may hold anything in place of an object's records: panels, timers and buttons go on."""

import json

import bpy
import pytest
from fake_layout import draw
from scenes import CUBE, activate, add, fair, to_object_mode

from addon.inspection import display
from addon.live import handlers
from addon.memory import keep, recall, unset_unsound_settings
from addon.registration import classes_of
from addon.surfaces import freshness
from addon.ui import inspect, main

PANELS = [panel for module in (main, inspect) for panel in classes_of(module)]
DEEP = "[" * 100_000 + "]" * 100_000
VALUES = (None, -1, 10**400, float("nan"), "x", [{}], {"x": "x"})
RECORDS = ("report", "carried", "made", "defects")


def surface():
    """A surface with all records."""
    add("Box", *CUBE)
    target = fair(levels=1, energy="TOTAL_CURVATURE")
    activate(target)
    bpy.ops.object.fairing_check()
    to_object_mode()
    return target


def redraw():
    """Draws as Blender does all the time while a surface is active."""
    for panel in PANELS:
        if panel is not main.VIEW3D_PT_fairing_presets:
            draw(panel)
    freshness._look()
    list(freshness.stale_surfaces())
    handlers.on_timer()


def spoilt(record):
    """The record with a wrong value in place of each of its values in turn, at any depth; of lists the first."""
    for key in list(record) if isinstance(record, dict) else range(len(record[:1])):
        value = record[key]
        for other in VALUES:
            record[key] = other
            yield record
        record[key] = value
        if isinstance(value, dict | list):
            yield from (record for _ in spoilt(value))


def test_nothing_is_in_the_panel_custom_properties():
    target = surface()
    bpy.ops.object.fairing_inspect(mode="MEAN")
    for owner in (target, target.data):
        assert not set(owner.keys()) - set(owner.bl_rna.properties.keys())
    assert all(recall(target, name) is not None for name in ("report", "defects"))
    target.discrete_fairing.report = "no JSON"
    assert recall(target, "report") is None


@pytest.mark.parametrize("name", RECORDS)
def test_records_that_nobody_can_have_written(name):
    target = surface()
    if name == "defects":
        holes = [{"edges": 4, "at": [0, 1], "width": 1.5}]
        record = {"defects": DEFECTS, "holes": holes, "cleaned": ["Done"], "counts": [1, 2, 3]}
        keep(target, name, record)
    record = json.loads(getattr(target.discrete_fairing, name))
    assert recall(target, name) == record
    texts = ("", "no JSON", "[1]", "5", "[]", "{}", "NaN", "\\")
    for text in (*texts, DEEP, '{"after":' * 5000, '{"source": 1' + "0" * 5000):
        setattr(target.discrete_fairing, name, text)
        redraw()
    for each in spoilt(record):
        setattr(target.discrete_fairing, name, json.dumps(each))
        if recall(target, name) is not None:  # else all is as without a record
            redraw()
    bpy.ops.object.fairing_recompute()


DEFECTS = [{"code": "NONMANIFOLD_EDGE", "message": "Text", "kind": "edge", "elements": [[0, 1]]}]
DEFECTS[0]["severity"] = "error"


def test_settings_without_a_meaning_are_those_that_nobody_has_set(tmp_path):
    target = surface()
    path = str(tmp_path / "spoilt.blend")
    settings, live = target.discrete_fairing, target.discrete_fairing_live
    scene = bpy.context.scene
    settings.pad_size = settings.tolerance = float("nan")
    live.cage_display = "NOTHING"
    stored = getattr(settings, "bl_system_properties_get", lambda: settings)()
    stored["energy"], stored["levels"] = 99, 2**30
    scene.discrete_fairing.weld = float("nan")
    scene.discrete_fairing_inspection.comb_scale = float("nan")
    target.data.discrete_fairing.curvature_range = (float("nan"), 1.0)
    target.data["fairing_curvature_range"] = DEEP
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    target, scene = bpy.data.objects["Box Fair"], bpy.context.scene
    settings = target.discrete_fairing
    assert (settings.energy, settings.levels, settings.pad_size) == ("THIN_PLATE", 3, 1.0)
    assert scene.discrete_fairing.weld == 0.0
    assert scene.discrete_fairing_inspection.comb_scale == 1.0
    assert display.legend(target.data) is None
    redraw()
    bpy.ops.object.fairing_recompute()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.objects = ["Box Fair"]
    unset_unsound_settings()
    linked = wanted.objects[0]
    assert linked.library and linked.discrete_fairing.levels == 3
    bpy.context.collection.objects.link(linked)
    activate(linked)
    redraw()


@pytest.mark.parametrize("scale", [float("nan"), float("inf"), 0.0])
def test_a_scale_that_is_no_number_stops_nothing(scale):
    target = surface()
    target.discrete_fairing.interpolation = "APPROXIMATE"
    target.discrete_fairing.source.scale.x = scale
    redraw()
    bpy.ops.object.fairing_recompute()
    assert len(target.data.polygons) == 6 * 4
