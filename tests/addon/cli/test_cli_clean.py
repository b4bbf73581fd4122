# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line makes closed surfaces of scans, as the operator and the package do."""

from pathlib import Path

import numpy as np
import pytest
from cli_files import read_obj
from cli_runs import entries, run
from test_cli_fill import open_edges, write_ball


def write_scan(name):
    """A ball with a hole, and a speck far away."""
    write_ball(name, open_above=0.9)
    lines = Path(name).read_text().splitlines()
    count = sum(line.startswith("v ") for line in lines)
    speck = ["v 3 3 0", "v 3.1 3 0", "v 3 3.1 0", f"f {count + 1} {count + 2} {count + 3}"]
    Path(name).write_text("\n".join(lines + speck) + "\n")


def test_a_scan_is_closed():
    write_scan("in.obj")
    code, (entry,) = entries("in.obj", "out.obj", "--clean")
    (item,) = entry["objects"]
    told = item["report"]
    assert code == 0 and entry["warnings"] == []
    assert open_edges("out.obj") == 0
    assert np.abs(np.linalg.norm(read_obj("out.obj"), axis=1) - 1).max() < 0.06
    assert {act["step"] for act in told["done"]} >= {"islands", "fill"}
    assert (told["watertight"], told["left"]) == (True, [])
    assert told["volume"] == pytest.approx(4.05, abs=0.1)
    # plain numbers: nobody knows what the file means by 1
    assert told["said"][-1] == f"Watertight: yes; volume {told['volume']:.3g}; left: nothing"


def test_what_is_left_is_warned_of_and_is_no_failure(capsys):
    write_scan("in.obj")
    words = ("--clean-without", "fill", "--clean-islands", 0)
    code, (entry,) = entries("in.obj", "out.obj", "--clean", *words)
    told = entry["objects"][0]["report"]
    assert code == 0 and entry["status"] == "done"
    assert (told["watertight"], told["volume"]) == (False, None)
    assert told["left"] == [{"code": "OPEN_HOLE", "count": 27}]
    (warning,) = entry["warnings"]
    assert warning == "Ball: Watertight: no; left: 27 edges are at holes."
    assert open_edges("out.obj") == 27
    assert run("in.obj", "again.obj", "--clean", "--largest-hole", 0.5) == 0
    line = capsys.readouterr().err.splitlines()[-1].split()
    assert line[0] == "in.obj" and line[-2:] == ["no", "24"]
    assert open_edges("again.obj") == 24
