# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line eases measured points, and writes the table of their strain."""

import csv
from pathlib import Path

import bpy
import discrete_fairing
import numpy as np
import pytest
from cli_runs import contains, entries, imported
from dunes import COLUMNS, FACES, OFF, ROWS, WRONG, dune
from scenes import add

from addon.strain import table
from addon.strain.measure import StrainJob


def scattered(size=0.02):
    """The dune as measured."""
    points = dune()
    points[:, 2] += np.random.default_rng(3).normal(0, size, len(points))
    return np.round(points, 6)


def write_dunes(name, *meshes):
    lines, first = [], 1
    for number, points in enumerate(meshes):
        lines.append(f"o Dune{number}")
        lines += ["v {:.6f} {:.6f} {:.6f}".format(*point) for point in points]
        lines += ["f " + " ".join(map(str, face + first)) for face in FACES]
        first += len(points)
    Path(name).write_text("\n".join(lines) + "\n")


def read_table(name):
    with Path(name).open(newline="") as file:
        head, *rows = csv.reader(file)
    return head, np.array([[float(field or "nan") for field in row] for row in rows])


def test_control_vertices_are_eased_and_the_surface_passes_through_them():
    points = scattered()
    write_dunes("in.obj", points)
    code, (entry,) = entries("in.obj", "out.obj", "--ease", "--levels", 1)
    assert (code, entry["settings"]["ease"], entry["settings"]["ease_tolerance"]) == (0, True, None)
    corners = [0, COLUMNS - 1, ROWS * COLUMNS - COLUMNS, ROWS * COLUMNS - 1]
    wanted = discrete_fairing.ease(points, FACES, levels=2, corner_vertices=corners)
    said = entry["objects"][0]["eased"]
    assert said["noise"] == pytest.approx(wanted.noise, rel=1e-3)
    assert (said["vertex"], said["moved"]) == (WRONG, np.count_nonzero(wanted.moves))
    assert said["largest"] == pytest.approx(wanted.moves[WRONG], rel=1e-3)
    surface, _ = imported("out.obj")
    assert contains(surface, wanted.vertices, 1e-4)
    assert not contains(surface, points, 0.1 * OFF)


def test_the_table_is_that_of_the_panel():
    write_dunes("in.obj", scattered())
    code, (entry,) = entries("in.obj", "out.obj", "--strain", "strain.csv")
    assert code == 0 and "eased" not in entry["objects"][0] and "ease" not in entry["settings"]
    head, rows = read_table("strain.csv")
    job = StrainJob(bpy.context, add("Dune", scattered().tolist(), FACES.tolist()))
    job.compute()
    assert head == table.rows(job.positions, job.result.lengths)[0]
    assert np.allclose(rows[:, 4], job.result.lengths, rtol=1e-3, atol=1e-5, equal_nan=True)
    said = entry["objects"][0]["strain"]
    assert said["vertex"] == int(np.nanargmax(np.abs(rows[:, 4]))) == WRONG
    assert said["wrong"] == [WRONG] and said["floor"] == pytest.approx(job.result.floor, rel=1e-2)


def test_a_table_is_of_one_mesh():
    write_dunes("in.obj", dune(), dune() + (0, 9, 0))
    code, (entry,) = entries("in.obj", "out.obj", "--strain", "a.csv")
    assert code == 1 and "2: Dune0, Dune1" in entry["error"]["message"]
    assert not Path("out.obj").exists()
    code, (entry,) = entries("in.obj", "out.obj", "--ease")
    assert code == 0 and [item["eased"]["vertex"] for item in entry["objects"]] == [WRONG, WRONG]
