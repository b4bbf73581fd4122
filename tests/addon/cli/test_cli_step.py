# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line writes STEP files."""

from pathlib import Path

import numpy as np
import pytest
import step_files
from cli_files import write_obj
from cli_runs import entries, run

from addon.cli.places import BadPlaces, places


def test_a_file_becomes_a_step_file_in_its_own_numbers():
    write_obj("in.obj", names=("Left", "Right"))
    code, (entry,) = entries("in.obj", "new/out.step", "--energy", "total_curvature")
    assert (code, entry["status"]) == (0, "done")
    assert [item["name"] for item in entry["objects"]] == ["Left", "Right"]
    assert [item["result"] for item in entry["objects"]] == 2 * [
        {"patches": 6, "solids": 1, "shells": 0}
    ]
    assert 0 < entry["objects"][0]["report"]["off"] < 1e-3
    found = step_files.read("new/out.step")
    assert (found.valid, found.solids, found.faces) == (True, 2, 12)
    assert np.allclose(found.centre, (2, 0, 0), atol=1e-3)


def test_units_say_what_the_numbers_are():
    write_obj("in.obj")
    words = ("--unit", "m", "--fit-tolerance", "1e-3", "--energy", "total_curvature")
    assert run("in.obj", "out.stp", *words) == 0
    assert ".METRE." in Path("out.stp").read_text()
    found = step_files.read("out.stp")
    assert 1000 < found.highest[0] < 2500


def test_no_file_in_is_a_step_file():
    with pytest.raises(BadPlaces, match="no known type"):
        places(["in.step"], "out.obj")
    assert places(["in.obj"], "fair/", "step")[0].target == Path("fair/in.step")
