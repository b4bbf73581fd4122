# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of Rhino, from Blender and from the command line, where rhino3dm is installed."""

import sys
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from cli_files import write_obj
from cli_runs import entries, run
from scenes import CUBE, add

from addon.operators.step import EXPORT_SCENE_OT_fairing_step

MISSING = "needs the Python module rhino3dm, which is not installed"


@pytest.fixture(autouse=True)
def own_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def read(path):
    """Names of layers, and (patches, 3) a corner of each surface."""
    rhino = pytest.importorskip("rhino3dm", reason="rhino3dm is not installed")
    model = rhino.File3dm.Read(str(path))
    corners = [item.Geometry.PointAt(0, 0) for item in model.Objects]
    return [layer.Name for layer in model.Layers], np.array([(p.X, p.Y, p.Z) for p in corners])


def test_the_command_line_writes_them(tmp_path):
    pytest.importorskip("rhino3dm", reason="rhino3dm is not installed")
    write_obj("in.obj", names=("Left", "Right"))
    code, (entry,) = entries("in.obj", "new/out.3dm", "--unit", "m")
    assert (code, entry["status"]) == (0, "done")
    assert entry["objects"][0]["result"]["patches"] == 6
    layers, corners = read("new/out.3dm")
    assert layers == ["Left", "Right"] and len(corners) == 12
    assert np.allclose(np.abs(corners[:6]), 1) and np.allclose(np.abs(corners[6:] - [4, 0, 0]), 1)


def test_blender_writes_them_in_the_unit_of_the_file(tmp_path):
    pytest.importorskip("rhino3dm", reason="rhino3dm is not installed")
    add("Box", *CUBE).location.x = 3
    path = str(tmp_path / "box.3dm")
    assert bpy.ops.export_scene.fairing_step(filepath=path, unit="CM", fit_levels=3) == {"FINISHED"}
    layers, corners = read(path)
    assert layers == ["Box"]
    assert np.allclose(np.abs(corners - [300, 0, 0]), 100)


def test_without_the_module_nothing_is_computed_and_the_message_says_why(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "rhino3dm", None)
    write_obj("in.obj")
    assert run("in.obj", "out.3dm") == 2
    assert MISSING in capsys.readouterr().err
    add("Box", *CUBE)
    with pytest.raises(RuntimeError, match=MISSING):
        bpy.ops.export_scene.fairing_step(filepath="box.3dm")


def test_the_type_decides_the_ending_of_the_name():
    """What the file browser puts to a name, and STEP at first."""
    types = bpy.ops.export_scene.fairing_step.get_rna_type().properties["file_type"]
    assert types.default == "STEP"
    endings = {}
    for item in types.enum_items:
        stand_in = SimpleNamespace(file_type=item.identifier)
        endings[item.identifier] = EXPORT_SCENE_OT_fairing_step.filename_ext.fget(stand_in)
    assert endings == {"STEP": ".step", "3DM": ".3dm"}
