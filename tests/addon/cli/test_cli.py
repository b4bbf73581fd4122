# SPDX-License-Identifier: GPL-3.0-or-later
"""The command on real files: finer meshes, and exit codes."""

import signal
from pathlib import Path

import numpy as np
import pytest
from cli_files import BOX_QUADS, read_obj, write_obj, write_ply, write_stl
from cli_runs import contains, imported, run

from addon import core
from addon.cli import main as command

WRITERS = {"obj": write_obj, "ply": write_ply, "stl": write_stl}


@pytest.mark.parametrize("into", WRITERS)
@pytest.mark.parametrize("out_of", WRITERS)
def test_control_vertices_come_out_where_they_went_in(out_of, into):
    points = WRITERS[out_of](f"in.{out_of}")
    assert run(f"in.{out_of}", f"out.{into}", "--levels", 2) == 0
    positions, sizes = imported(f"out.{into}")
    assert contains(positions, points, 1e-6)
    quads = out_of != "stl" and into != "stl"
    assert set(sizes) == ({4} if quads else {3})
    assert len(sizes) == BOX_QUADS * 4**2 * (1 if quads else 2)
    assert {path.name for path in Path().iterdir()} == {f"in.{out_of}", f"out.{into}"}


def test_objects_keep_their_names_and_their_materials():
    points = write_obj("in.obj", names=("Left", "Right"), materials=("red", "blue"))
    assert run("in.obj", "out.obj", "--levels", 1) == 0
    text = Path("out.obj").read_text()
    assert [line[2:] for line in text.splitlines() if line.startswith("o ")] == ["Left", "Right"]
    used = {line for line in text.splitlines() if line.startswith("usemtl")}
    assert used == {"usemtl red", "usemtl blue"}
    assert Path("out.mtl").exists()
    assert contains(read_obj("out.obj"), points, 1e-6)


def test_welding_closes_what_is_apart():
    write_obj("in.obj", shared=False)
    counts = []
    for words in ((), ("--weld", 0)):
        assert run("in.obj", "out.obj", "--levels", 1, *words) == 0
        counts.append(len(read_obj("out.obj")))
    assert counts[0] == 6 * 9 and counts[1] < counts[0]


@pytest.mark.parametrize(
    ("name", "content", "why"),
    [
        ("nothing.obj", b"", "is empty"),
        ("nothing.ply", b"", "is empty"),
        ("nothing.stl", b"", "is empty"),
        ("noise.obj", b"\x00\x01 not a mesh\n", "has no mesh"),
        ("noise.ply", b"\x00\x01 not a mesh\n", "cannot be read"),
        ("noise.stl", b"\x00\x01 not a mesh\n", "cannot be read"),
        ("points.obj", b"v 0 0 0\nv 1 0 0\n", "has no faces"),
        ("missing.obj", None, "cannot be read"),
    ],
)
def test_what_cannot_be_read_is_named(name, content, why, capfd):
    if content is not None:
        Path(name).write_bytes(content)
    assert run(name, "out.obj") == command.FAILED
    said = capfd.readouterr().err
    assert f"error: {name}" in said and why in said
    assert not Path("out.obj").exists()


def test_a_mesh_that_is_refused_says_why(capfd):
    Path("bad.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 -1\nf 1 2 3\nf 1 2 4\n")
    assert run("bad.obj", "out.obj", "--repair", "refuse") == command.FAILED
    assert "error: bad.obj: " in capfd.readouterr().err


def test_settings_reach_the_core():
    points = write_obj("in.obj")
    assert run("in.obj", "out.obj", "--levels", 1, "--crease-angle", 30, "--threads", 1) == 0
    # all edges creased: the box itself
    assert np.allclose(np.abs(read_obj("out.obj")).max(axis=1), 1.0)
    # the other energies find a sphere there and move nothing
    near = ("--tolerance", 0.1, "--energy", "thin_plate")
    assert run("in.obj", "out.obj", "--levels", 1, *near) == 0
    away = np.linalg.norm(read_obj("out.obj")[: len(points)] - points, axis=1)
    assert 0 < away.max() <= 0.1 * (1 + 1e-5)


def test_an_output_that_cannot_be_written(capfd):
    write_obj("in.obj")
    Path("file").write_text("in the way")
    assert run("in.obj", "file/out.obj") == command.FAILED
    assert "file/out.obj cannot be written" in capfd.readouterr().err


TO = "in.obj out.obj"


@pytest.mark.parametrize(
    "words, said",
    [
        ("in.obj", ""),
        ("in.obj ./in.obj", "is the input"),
        ("link.obj in.obj", "is the input"),
        ("in.fbx out.obj", "known types are OBJ, PLY, STL"),
        ("in.obj out.fbx", ""),
        (f"{TO} --levels 0", ""),
        (f"{TO} --lev 2", ""),
        (f"{TO} --crease-angle 181", ""),
        (f"{TO} --interpolation exact --tolerance 0.1", ""),
        (f"{TO} --unit mm", "--unit needs an output that ends in .step"),
        (f"{TO} --largest-hole 9", "--largest-hole needs --clean"),
        (f"{TO} --clean-noise", "--clean-noise needs --clean"),
        (f"{TO} --clean --levels 2", "--levels is for fairing"),
        (f"{TO} --clean --weld 0", "--weld is for fairing"),
        (f"{TO} --clean --largest-hole -2", "is not a number, 0 or more"),
        ("in.obj out.step --clean", "STEP"),
        (f"{TO} --clean --energy thin_plate", "--energy is for fairing, and --clean does not"),
        (f"{TO} --clean --clean-islands 2", "from 0 to 1"),
        (f"{TO} --cage c.obj", "--cage needs --fit"),
        ("--fit in.obj out.obj --cage cage.dwg", "no known type"),
        ("--fit in.obj out.obj --energy total_curvature", "--energy is not for"),
        ("--fit in.obj out.obj --cage c.obj --cage-faces 9", "give one of"),
        ("--fit in.obj out.obj --tolerance 0", "must be over 0"),
    ],
)
def test_wrong_usage_is_two(words, said, capfd):
    write_obj("in.obj")
    Path("link.obj").hardlink_to("in.obj")
    before = Path("in.obj").read_bytes()
    assert run(*words.split()) == command.WRONG_USAGE
    error = capfd.readouterr().err
    assert "usage: " in error and said in error
    assert Path("in.obj").read_bytes() == before
    assert not Path("out.obj").exists()


def test_without_the_native_module_it_is_three(monkeypatch, capfd):
    monkeypatch.setattr(core, "_load", lambda: (None, core.MISSING))
    write_obj("in.obj")
    assert run("in.obj", "out.obj") == command.NO_NATIVE_MODULE
    assert core.MISSING in capfd.readouterr().err
    assert run("--version") == 0


@pytest.mark.parametrize("interrupted", [False, True])
def test_an_interruption_and_a_fault_of_ours_write_nothing(interrupted, monkeypatch, capfd):
    write_obj("in.obj")

    class Faulty(command.Job):
        def compute(self, **watchers):
            if interrupted:
                signal.raise_signal(signal.SIGINT)
            super().compute(**watchers)

        def warnings(self):
            raise AttributeError("oops")

    monkeypatch.setattr(command, "Job", Faulty)
    code = run("in.obj", "out.obj")
    assert code == (command.INTERRUPTED if interrupted else command.FAILED)
    assert ("in.obj: interrupted" if interrupted else "oops") in capfd.readouterr().err
    assert not Path("out.obj").exists()
