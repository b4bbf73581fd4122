# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line makes closed surfaces of scans."""

import re
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from cli_files import read_obj
from cli_runs import run

from addon.cli.files import read_file


def write_ball(name, open_above=0.7, sides=24, rings=12):
    """A sphere of quads around its waist and triangles at its poles, open above."""
    lines, at = ["o Ball"], {}
    for r in range(1, rings):
        height, radius = np.cos(np.pi * r / rings), np.sin(np.pi * r / rings)
        for s in range(sides):
            at[r, s] = len(at) + 1
            angle = 2 * np.pi * s / sides
            lines.append(
                f"v {radius * np.cos(angle):.6f} {radius * np.sin(angle):.6f} {height:.6f}"
            )
    lines.append("v 0 0 -1")
    for r in range(1, rings - 1):
        for s in range(sides):
            if np.cos(np.pi * r / rings) < open_above:
                t = (s + 1) % sides
                lines.append(f"f {at[r, s]} {at[r + 1, s]} {at[r + 1, t]} {at[r, t]}")
    last = rings - 1
    lines += [f"f {at[last, s]} {len(at) + 1} {at[last, (s + 1) % sides]}" for s in range(sides)]
    Path(name).write_text("\n".join(lines) + "\n")


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
    write_ball(name, open_above=0.9)
    lines = Path(name).read_text().splitlines()
    count = sum(line.startswith("v ") for line in lines)
    speck = ["v 3 3 0", "v 3.1 3 0", "v 3 3.1 0", f"f {count + 1} {count + 2} {count + 3}"]
    Path(name).write_text("\n".join(lines + speck) + "\n")


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
    left = "warning: Ball: Watertight: no; left: 27 edges are at holes."
    assert left in capsys.readouterr().err
    assert open_edges("out.obj") == 27
    assert run("in.obj", "again.obj", "--clean", "--largest-hole", 0.5) == 0
    assert "left: 24 edges are at holes" in capsys.readouterr().err
    assert open_edges("again.obj") == 24
