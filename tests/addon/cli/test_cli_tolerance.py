# SPDX-License-Identifier: GPL-3.0-or-later
"""Tolerances on the command line: a length, a share of the edges, a number for each vertex."""

from pathlib import Path

from cli_files import lopsided, write_ply
from cli_runs import contains, imported, run


def write_ply_with(name, property_name, values):
    """The box with a float property of its vertices."""
    write_ply(name)
    lines = Path(name).read_text().splitlines()
    lines.insert(lines.index("property float z") + 1, f"property float {property_name}")
    first = lines.index("end_header") + 1
    for number, value in enumerate(values, first):
        lines[number] += f" {value}"
    Path(name).write_text("\n".join(lines) + "\n")


def test_a_group_on_the_command_line():
    write_ply_with("in.ply", "loose", [0] * 4 + [1.0] * 4)
    points = lopsided()
    group = ("--tolerance", 0.05, "--tolerance-group", "loose")
    assert run("in.ply", "out.ply", "--levels", 1, *group) == 0
    positions, _ = imported("out.ply")
    assert contains(positions, points[:4], 1e-6) and not contains(positions, points[4:], 1e-3)
