# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel computes and draws, on a layout that only remembers."""

from dataclasses import asdict
from types import SimpleNamespace

import bpy
import pytest
from fake_layout import Layout, draw
from scenes import CUBE, add, add_suzanne, face_values, fair

import addon
from addon import core, size
from addon.choices import (
    ENERGIES,
    ENERGY_MEANINGS,
    ENERGY_NAMES,
    INTERPOLATIONS,
    SHORT_INTERPOLATIONS,
)
from addon.operators.fair import FairSurface
from addon.properties import copy_settings, fill_in
from addon.purposes import FOLDER, PRESET_FOLDER, PURPOSES
from addon.settings import NAMES, Settings
from addon.ui import layout as settings_layout
from addon.ui import main, menus, pictures
from addon.ui.layout import Sidebar


def test_an_operator_shows_all_of_it_too():
    """As in Adjust Last Operation, with what is folded open."""
    drawn = []

    class OBJECT_OT_drawn(FairSurface, bpy.types.Operator):
        bl_idname = "object.drawn"

        def execute(self, _context):
            settings_layout.draw_settings(Layout(drawn), self, self.bl_idname)
            return {"FINISHED"}

    add("Box", *CUBE)
    bpy.utils.register_class(OBJECT_OT_drawn)
    try:
        assert bpy.ops.object.drawn() == {"FINISHED"}
    finally:
        bpy.utils.unregister_class(OBJECT_OT_drawn)
    assert {"Fairness", "energy", "crease_angle", "corner_angle", "metric_exponent"} <= set(drawn)


def test_every_setting_is_shown_somewhere():
    add("Box", *CUBE)
    settings = bpy.context.scene.discrete_fairing
    settings.interpolation = "APPROXIMATE"
    settings.use_selection = True
    panels = [cls for cls in main.CLASSES if issubclass(cls, Sidebar)]
    log = [entry for cls in panels for entry in draw(cls)]
    settings.interpolation = "LIMIT"
    log += [entry for cls in panels for entry in draw(cls)]
    assert set(NAMES) <= set(log)


def near(**changes):
    """The panel's lines with Near chosen."""
    settings = bpy.context.scene.discrete_fairing
    settings.interpolation = "APPROXIMATE"
    for name, value in changes.items():
        setattr(settings, name, value)
    return draw(main.VIEW3D_PT_fairing)


def test_the_tolerance_is_shown_where_it_counts():
    add("Box", *CUBE)
    assert "tolerance" not in draw(main.VIEW3D_PT_fairing)
    assert "tolerance" in near()


def test_the_tolerance_says_its_length():
    add("Box", *CUBE)  # edges of 2
    assert "= 0.25 m" in near(tolerance=0.125)
    bpy.context.scene.unit_settings.scale_length = 0.001
    bpy.context.scene.unit_settings.length_unit = "MILLIMETERS"
    assert "= 0.25 mm" in near(tolerance=0.125)
    bpy.context.scene.unit_settings.system = "NONE"
    assert "= 0.25" in near(tolerance=0.125)
    assert "= 0.125" in near(tolerance_unit="SCENE")
    assert not [line for line in near(mesh_source="EVALUATED") if line.startswith("= ")]


def test_a_surface_from_curves_is_held_along_them():
    """By a group, so that a tolerance of 0 would be no answer."""
    settings = bpy.context.scene.discrete_fairing
    settings.interpolation, settings.pull_group = "APPROXIMATE", "On Curves"
    add("Box", *CUBE)
    assert "Held along its curves" in draw(main.VIEW3D_PT_fairing)


def test_a_group_that_is_not_there_is_said():
    box = add("Box", *CUBE)
    assert "Not in Box" in near(tolerance_group="Loose")
    box.vertex_groups.new(name="Loose")
    assert "Not in Box" not in near()
    assert "Not in Box" not in near(tolerance_group="Made by a modifier", mesh_source="EVALUATED")


def test_triangle_count_stands_under_the_levels():
    add("Box", *CUBE)
    shown = draw(main.VIEW3D_PT_fairing)
    assert shown[shown.index("levels") + 1] == "768 triangles"


@pytest.fixture
def named(monkeypatch):
    """Pictures by their names: without a window they have no numbers."""
    monkeypatch.setattr(pictures, "icon", lambda key: f"picture of {key}")


@pytest.mark.parametrize("own", [False, True], ids=["none of one's own", "one of one's own"])
def test_a_preset_can_be_saved(own, tmp_path):
    """Also as the first one: then Blender has no folder for them yet."""
    (tmp_path / "Mine.py").write_text("")
    instance = SimpleNamespace(layout=Layout(), bl_idname="VIEW3D_PT_fairing_presets")
    shipped = str(FOLDER / PRESET_FOLDER)
    main.VIEW3D_PT_fairing_presets.path_menu(
        instance,
        [shipped, str(tmp_path)] if own else [shipped],
        "object.fairing_preset_apply",
        filter_ext=lambda ext: ext == ".py",
        add_operator="object.fairing_preset_add",
    )
    log = instance.layout.log
    assert log.count("object.fairing_preset_apply") == own
    assert log[-2:] == ["preset_name", "object.fairing_preset_add"]


def test_what_the_surface_is_for_comes_first(named):
    add("Box", *CUBE)
    shown = draw(main.VIEW3D_PT_fairing)
    first = shown[: shown.index("levels")]
    assert first[0] == "Fair for"
    each = [(f"picture of {key}", "object.fairing_for") for key, *_ in PURPOSES]
    pictures = [entry for entry in first if entry in dict(each) or entry == "object.fairing_for"]
    assert pictures == [entry for pair in each for entry in pair]


def test_a_surface_that_is_there_has_its_settings_first():
    add("Box", *CUBE)
    fair(levels=1)
    assert "object.fairing_for" not in draw(main.VIEW3D_PT_fairing)


@pytest.mark.parametrize(
    ("choices", "labels"),
    [(ENERGIES, ENERGY_NAMES), (INTERPOLATIONS, SHORT_INTERPOLATIONS)],
)
def test_each_choice_has_its_picture_over_it(named, choices, labels):
    add("Box", *CUBE)
    shown = draw(main.VIEW3D_PT_fairing)
    assert set(labels) == {key for key, *_ in choices}
    for key, label in labels.items():
        assert shown[shown.index(label) - 1] == f"picture of {key}"
        assert key.title() in pictures._loaded


@pytest.mark.parametrize("energy", ["THIN_PLATE", "TOTAL_CURVATURE"])
def test_a_slider_shows_both_its_ends(named, energy):
    add("Box", *CUBE)
    bpy.context.scene.discrete_fairing.energy = energy
    shown = draw(main.VIEW3D_PT_fairing)
    start = shown.index("pad_size") + 1
    ends = [f"picture of {energy}", "0", f"picture of {energy}_SOFTLY", "1"]
    assert shown[start : start + 4] == ends
    assert f"{energy}_SOFTLY".title() in pictures._loaded


@pytest.mark.parametrize("energy", [key for key, *_ in ENERGIES])
def test_a_beginner_has_fairness_levels_and_vertices_above_the_button(energy):
    add("Box", *CUBE)
    bpy.context.scene.discrete_fairing.energy = energy
    shown = draw(main.VIEW3D_PT_fairing)
    order = ["levels", "Fairness", "Vertices", "object.fairing_surface", "More", "pad_size"]
    places = [shown.index(name) for name in order]
    assert places == sorted(places)
    assert shown[shown.index("energy") : places[2]][-1] == ENERGY_MEANINGS[energy]


class Given(SimpleNamespace):
    """An operator's properties, some of them set by whoever calls it."""

    def is_property_set(self, name):
        return name in self.given


def test_what_is_not_said_is_that_of_the_panel():
    settings = bpy.context.scene.discrete_fairing
    settings.levels, settings.tension = 4, 0.5
    settings.tolerance = 0.125
    given = Given(given={"tension"}, **asdict(Settings.of(settings)))
    given.levels, given.tension, given.tolerance = 1, 0.25, 0.0
    fill_in(settings, given)
    assert (given.levels, given.tension, given.tolerance) == (4, 0.25, 0.125)


def test_menus_have_every_operator():
    """Blender's search finds what stands in a menu."""
    add("Box", *CUBE)
    log = draw(menus.VIEW3D_MT_fairing) + draw(menus.VIEW3D_MT_fairing_boundary)
    log += draw(menus.VIEW3D_MT_fairing_normals) + draw(menus.VIEW3D_MT_fairing_for)
    own = {f"object.{name}" for name in dir(bpy.ops.object) if name.startswith("fairing_")}
    # those of a line, a viewport or a preset, and what Adjust Last Operation calls
    others = {
        "select_defect",
        "go_to_strained",
        "select_hole",
        "select_joint",
        "repair",
        "viewport",
        "preset_add",
        "preset_apply",
        "complete",
        "cancel",
    }
    assert own - {f"object.fairing_{name}" for name in others} == {
        entry for entry in log if entry.startswith("object.")
    }


@pytest.mark.parametrize("name", menus._ENTRIES)
def test_blender_draws_the_menus(name):
    assert menus._ENTRIES[name] in getattr(bpy.types, name)._dyn_ui_initialize()
    addon.unregister()
    assert menus._ENTRIES[name] not in getattr(bpy.types, name)._dyn_ui_initialize()
    addon.register()


def test_a_large_result_is_announced():
    add("Box", *CUBE)
    bpy.context.scene.discrete_fairing.levels = 10
    assert any("large" in text for text in draw(main.VIEW3D_PT_fairing))


def test_missing_core_is_said_in_the_panel(monkeypatch):
    monkeypatch.setattr(core, "_load", lambda: (None, core.MISSING))
    assert " ".join(draw(main.VIEW3D_PT_fairing)) == core.MISSING


@pytest.mark.parametrize("levels", [1, 3])
def test_count_is_what_comes(levels):
    source = add_suzanne()
    bpy.ops.object.fairing_surface(levels=levels, energy="THIN_PLATE")
    fine = face_values(bpy.context.object.data, "loop_total", "i")
    assert size.triangle_count(size.face_sizes(source.data), levels) == int((fine - 2).sum())


@pytest.mark.parametrize(
    "sizes, triangles", [([], 0), ([3], 1), ([4], 2), ([5], 5), ([3, 4, 6], 9)]
)
def test_coarse_triangles(sizes, triangles):
    assert size.coarse_triangles(sizes) == triangles


def test_copy_settings():
    class Target:
        pass

    copy_settings(bpy.context.scene.discrete_fairing, Target)
    assert {name for name in vars(Target) if not name.startswith("_")} == set(NAMES)


def test_a_grey_button_says_what_to_do():
    assert "Select a mesh object first" in draw(main.VIEW3D_PT_fairing)
    add("Box", *CUBE)
    assert "Select a mesh object first" not in draw(main.VIEW3D_PT_fairing)


def test_what_is_grey_says_why():
    add("Box", *CUBE)
    bpy.context.scene.discrete_fairing.energy = "MINIMUM_VARIATION"
    said = draw(main.VIEW3D_PT_fairing)
    assert "Used for the start only" in said and "Not with this fairness" in said
