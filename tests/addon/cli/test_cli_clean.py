# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line makes closed surfaces of scans."""

import re
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from cli_files import read_obj, write_faces
from cli_runs import run
from ragged_holes import sphere

from addon.cli.files import read_file


def open_edges(path):
    uses = Counter(
        tuple(sorted(edge))
        for item in read_file(Path(path))
        for face in item.data.polygons
        for edge in face.edge_keys
    )
    return sum(count == 1 for count in uses.values())


def write_scan(name):
    """A ball with a hole, and a speck far away."""
    points, faces = sphere()
    speck = [(3, 3, 0), (3.1, 3, 0), (3, 3.1, 0)]
    kept = faces[points[faces].mean(axis=1)[:, 2] < 0.9].tolist()
    write_faces(name, [*points.tolist(), *speck], [*kept, [len(points) + k for k in range(3)]])


def test_a_scan_is_closed(capsys):
    write_scan("in.obj")
    assert run("in.obj", "out.obj", "--clean") == 0
    assert open_edges("out.obj") == 0
    assert np.abs(np.linalg.norm(read_obj("out.obj"), axis=1) - 1).max() < 0.06
    said = capsys.readouterr().err
    assert "1 island dropped" in said and "1 hole filled" in said and "warning" not in said
    # plain numbers: nobody knows what the file means by 1
    volume = float(re.search(r"Watertight: yes; volume ([\d.]+); left: nothing", said)[1])
    assert volume == pytest.approx(4.05, abs=0.1)


def test_what_is_left_is_warned_of_and_is_no_failure(capsys):
    write_scan("in.obj")
    words = ("--clean-without", "fill", "--clean-islands", 0)
    assert run("in.obj", "out.obj", "--clean", *words) == 0
    left = "warning: Scan: Watertight: no; left: 15 edges are at holes."
    assert left in capsys.readouterr().err
    assert open_edges("out.obj") == 15
    assert run("in.obj", "again.obj", "--clean", "--largest-hole", 0.5) == 0
    assert "left: 12 edges are at holes" in capsys.readouterr().err
    assert open_edges("again.obj") == 12
