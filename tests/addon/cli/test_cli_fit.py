# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line writes STEP files, and draws cages to scans."""

import re
from pathlib import Path

import numpy as np
import pytest
import step_files
from cli_files import read_obj, write_faces, write_obj
from cli_runs import run
from scans import blob_cage, blob_scan, cube_sphere, distance_to_blob, rms

NOISE = 0.004


def write_points(name, points):
    head = ["ply", "format ascii 1.0", f"element vertex {len(points)}"]
    head += [f"property float {axis}" for axis in "xyz"] + ["end_header"]
    Path(name).write_text("\n".join([*head, *("{} {} {}".format(*p) for p in points)]) + "\n")


@pytest.fixture
def blob():
    """A cloud of points, and a cage for it."""
    write_points("scan.ply", blob_scan(8000, NOISE))
    write_faces("cage.obj", *blob_cage(4, 0.02))


def within(said):
    """The distance within which 95 % of the scan are, as told."""
    return float(re.search(r"ithin ([\d.]+)(?: mm)? of 95 % of the scan", said)[1])


def test_points_and_a_cage_become_a_step_file_whose_distances_are_told(blob, capsys):
    words = ("--fit", "scan.ply", "--cage", "cage.obj", "out.step", "--levels", 3)
    assert run(*words, "--fit-tolerance", 1e-3) == 0
    said = capsys.readouterr().err
    patches = int(re.search(r"→ (\d+) patches in", said)[1])
    assert 6 <= patches < 96, "rows of the cage's 96 quads are one patch"
    assert within(said) == pytest.approx(1.96 * NOISE, rel=0.15)
    found = step_files.read("out.step")
    assert (found.valid, found.solids, found.faces) == (True, 1, patches)


def test_a_tolerance_is_a_length_or_a_share_of_the_cages_edge(blob, capsys):
    near = []
    for tolerance in ("0.02", "4%"):
        words = ("--fit", "scan.ply", "--cage", "cage.obj", "--tolerance", tolerance, "--levels", 2)
        assert run(*words, "out.obj") == 0
        near.append(within(capsys.readouterr().err))
    assert 0.01 < near[0] <= 0.02 and 1.96 * NOISE < near[1] < 0.04
    assert rms(distance_to_blob(read_obj("out.obj"))) < 0.02


def test_a_scan_alone_gets_a_cage(capsys):
    sphere, quads = cube_sphere(20)
    noise = 1 + 0.003 * np.random.default_rng(1).standard_normal((len(sphere), 1))
    write_faces("scan.obj", sphere * noise, quads)
    assert run("--fit", "scan.obj", "--cage-faces", 60, "out.obj", "--levels", 2) == 0
    said = capsys.readouterr().err
    cage, made = map(
        int, re.search(r"(\d+) faces → ([\d,]+) faces", said.replace(",", "")).groups()
    )
    assert 30 < cage < 200 and made == 16 * cage
    assert np.abs(np.linalg.norm(read_obj("out.obj"), axis=1) - 1).max() < 0.02
    assert "its noise is about 0.00" in said


def test_points_alone_need_a_cage(blob, capsys):
    assert run("--fit", "scan.ply", "out.obj") == 1
    assert "give it as --cage" in capsys.readouterr().err


def test_a_file_becomes_a_step_file_in_its_own_numbers():
    write_obj("in.obj", names=("Left", "Right"))
    assert run("in.obj", "new/out.step", "--energy", "total_curvature") == 0
    assert {"'Left'", "'Right'"} <= set(
        re.findall(r"PRODUCT\(('\w+')", Path("new/out.step").read_text())
    )
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
