# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel's texts and operators, on a layout that only remembers."""

from dataclasses import asdict
from types import SimpleNamespace

import bpy
import pytest
from fake_layout import Layout, draw
from scenes import CUBE, add, add_suzanne, face_values, fair

from addon import core, size
from addon.operators.fair import FairSurface
from addon.properties import fill_in
from addon.purposes import FOLDER, PRESET_FOLDER
from addon.registration import classes_of
from addon.settings import NAMES, Settings
from addon.ui import layout as settings_layout
from addon.ui import main, menus, pictures
from addon.ui.layout import Sidebar


def test_an_operator_shows_all_of_it_too(monkeypatch):
    """Adjust Last Operation shows all settings, folded ones open."""
    drawn = []
    monkeypatch.setattr(
        FairSurface,
        "execute",
        lambda self, _: (
            settings_layout.draw_settings(Layout(drawn), self, self.bl_idname) or {"FINISHED"}
        ),
    )
    add("Box", *CUBE)
    fair()
    assert {"Fairness", "energy", "crease_angle", "corner_angle", "metric_exponent"} <= set(drawn)


def test_every_setting_is_shown_somewhere():
    add("Box", *CUBE)
    settings = bpy.context.scene.discrete_fairing
    settings.interpolation = "APPROXIMATE"
    settings.use_selection = True
    panels = [cls for cls in classes_of(main) if issubclass(cls, Sidebar)]
    log = [entry for cls in panels for entry in draw(cls)]
    settings.interpolation = "LIMIT"
    log += [entry for cls in panels for entry in draw(cls)]
    assert set(NAMES) <= set(log)
    names = (settings_layout.INTERPOLATION_NAMES | settings_layout.ENERGY_NAMES).keys() - {"AUTO"}
    assert all((pictures.SETTINGS / f"{pictures.stem(name)}.png").is_file() for name in names)


def near(**changes):
    """The panel's lines with Near chosen."""
    settings = bpy.context.scene.discrete_fairing
    settings.interpolation = "APPROXIMATE"
    for name, value in changes.items():
        setattr(settings, name, value)
    return draw(main.VIEW3D_PT_fairing)


def test_the_tolerance_says_its_length():
    assert "Select a mesh object first" in draw(main.VIEW3D_PT_fairing)
    add("Box", *CUBE)  # edges of 2
    shown = draw(main.VIEW3D_PT_fairing)
    assert not {"tolerance", "Select a mesh object first"} & set(shown)
    assert "= 0.25 m" in near(tolerance=0.125)
    bpy.context.scene.unit_settings.scale_length = 0.001
    bpy.context.scene.unit_settings.length_unit = "MILLIMETERS"
    assert "= 0.25 mm" in near(tolerance=0.125)
    bpy.context.scene.unit_settings.system = "NONE"
    assert "= 0.25" in near(tolerance=0.125)
    assert "= 0.125" in near(tolerance_unit="SCENE")
    assert not [line for line in near(mesh_source="EVALUATED") if line.startswith("= ")]
    # by a group, so that a tolerance of 0 would be no answer
    assert "Held along its curves" in near(pull_group="On Curves")
    assert any("large" in text for text in near(levels=10))


@pytest.mark.parametrize("own", [False, True], ids=["none of one's own", "one of one's own"])
def test_a_preset_can_be_saved(own, tmp_path):
    """Also the first one, before Blender has a folder for presets."""
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


class Given(SimpleNamespace):
    """An operator's properties, some of them set by the caller."""

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
    """Blender's search finds the entries of menus."""
    add("Box", *CUBE)
    log = draw(menus.VIEW3D_MT_fairing) + draw(menus.VIEW3D_MT_fairing_boundary)
    log += draw(menus.VIEW3D_MT_fairing_normals) + draw(menus.VIEW3D_MT_fairing_for)
    own = {f"object.{name}" for name in dir(bpy.ops.object) if name.startswith("fairing_")}
    # those of a line, a viewport or a preset, and what Adjust Last Operation calls
    others = "select_defect go_to_strained select_hole select_joint repair viewport preset_add"
    others = {f"object.fairing_{name}" for name in f"{others} preset_apply complete cancel".split()}
    assert own - others == {entry for entry in log if entry.startswith("object.")}


def test_only_what_changes_data_is_a_step_of_undo():
    names = [name for name in dir(bpy.ops.object) if name.startswith("fairing_")]
    without = {n[8:] for n in names if "UNDO" not in getattr(bpy.ops.object, n).bl_options}
    assert without == {
        *("cancel", "for", "hydrostatics_table", "joints", "preset_add", "preset_apply"),
        "strain_table",
    }


def test_missing_core_is_said_in_the_panel(monkeypatch):
    monkeypatch.setattr(core, "_load", lambda: (None, core.MISSING))
    assert " ".join(draw(main.VIEW3D_PT_fairing)) == core.MISSING


@pytest.mark.parametrize("levels", [1, 3])
def test_count_is_what_comes(levels):
    source = add_suzanne()
    bpy.ops.object.fairing_surface(levels=levels, energy="THIN_PLATE")
    fine = face_values(bpy.context.object.data, "loop_total", "i")
    assert size.triangle_count(face_values(source.data, "loop_total", "i"), levels) == int(
        (fine - 2).sum()
    )
