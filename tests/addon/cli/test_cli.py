# SPDX-License-Identifier: GPL-3.0-or-later
"""The command on real files: finer meshes, exit codes and a report."""

import signal
from pathlib import Path

import numpy as np
import pytest
from cli_files import BOX_QUADS, read_obj, write_obj, write_ply, write_stl
from cli_runs import contains, entries, imported, run

from addon import core
from addon.cli import main as command
from addon.cli import one_file

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


def test_merge_closes_what_is_apart():
    write_obj("in.obj", shared=False)
    _, (apart,) = entries("in.obj", "apart.obj", "--levels", 1)
    _, (merged,) = entries("in.obj", "merged.obj", "--levels", 1, "--merge")
    assert apart["objects"][0]["control"]["vertices"] == 24
    assert merged["objects"][0]["control"]["vertices"] == 8


def test_many_files_and_one_that_is_bad(capfd):
    write_obj("a.obj")
    write_ply("b.ply")
    Path("bad.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 -1\nf 1 2 3\nf 1 2 4\n")
    code, (a, bad, b) = entries(
        *("a.obj", "bad.obj", "b.ply", "new/deep/", "--format", "stl", "--levels", 1),
        *("--repair", "refuse"),
    )
    assert code == command.SOME_FAILED
    assert (a["status"], bad["status"], b["status"]) == ("done", "failed", "done")
    assert bad["error"]["code"] == "INCONSISTENT_ORIENTATION" and bad["error"]["elements"]
    assert sorted(path.name for path in Path("new/deep").iterdir()) == ["a.stl", "b.stl"]
    assert "error: bad.obj: " in capfd.readouterr().err


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("nothing.obj", b"", "UNREADABLE"),
        ("nothing.ply", b"", "UNREADABLE"),
        ("nothing.stl", b"", "UNREADABLE"),
        ("noise.obj", b"\x00\x01 not a mesh\n", "NO_MESH"),
        ("noise.ply", b"\x00\x01 not a mesh\n", "UNREADABLE"),
        ("noise.stl", b"\x00\x01 not a mesh\n", "UNREADABLE"),
        ("points.obj", b"v 0 0 0\nv 1 0 0\n", "NO_FACES"),
        ("missing.obj", None, "UNREADABLE"),
    ],
)
def test_what_cannot_be_read_is_named(name, content, code, capfd):
    if content is not None:
        Path(name).write_bytes(content)
    exit_code, (entry,) = entries(name, "out.obj")
    assert (exit_code, entry["status"], entry["error"]["code"]) == (1, "failed", code)
    assert name in entry["error"]["message"] and entry["error"]["message"] in capfd.readouterr().err
    assert not Path("out.obj").exists()


def test_settings_reach_the_core():
    write_obj("in.obj")
    _, (entry,) = entries("in.obj", "out.obj", "--levels", 1, "--crease-angle", 30, "--threads", 1)
    assert entry["settings"]["use_crease_angle"]
    assert np.isclose(entry["settings"]["crease_angle"], np.radians(30))
    assert entry["objects"][0]["report"]["threads"] == 1
    # all edges creased: the box itself
    assert np.allclose(np.abs(read_obj("out.obj")).max(axis=1), 1.0)
    # the other energies find a sphere there and move nothing
    near = ("--tolerance", 0.1, "--energy", "thin_plate")
    _, (entry,) = entries("in.obj", "out.obj", "--levels", 1, *near)
    assert 0 < entry["objects"][0]["report"]["largest_deviation"] <= 0.1 * (1 + 1e-6)


def test_an_output_that_exists_is_replaced_unless_it_is_to_be_kept():
    write_obj("in.obj")
    Path("out.obj").write_text("old")
    code, (entry,) = entries("in.obj", "out.obj", "--no-overwrite")
    assert (code, entry["error"]["code"], Path("out.obj").read_text()) == (1, "EXISTS", "old")
    assert run("in.obj", "out.obj") == 0
    assert Path("out.obj").read_text() != "old"


def test_an_output_that_cannot_be_written():
    write_obj("in.obj")
    Path("file").write_text("in the way")
    code, (entry,) = entries("in.obj", "file/out.obj")
    assert (code, entry["error"]["code"]) == (1, "UNWRITABLE")
    assert run("in.obj", "out.obj", "--json", "file/report.json") == command.SOME_FAILED


TO = "in.obj out.obj"


@pytest.mark.parametrize(
    "words, said",
    [
        ("in.obj", ""),
        ("in.obj in.obj", ""),
        ("in.obj out.fbx", ""),
        (f"{TO} --levels 0", ""),
        (f"{TO} --lev 2", ""),
        (f"{TO} --crease-angle 181", ""),
        (f"{TO} --interpolation exact --tolerance 0.1", ""),
        (f"{TO} --unit mm", "--unit needs an output that ends in .step"),
        (f"{TO} --largest-hole 9", "--largest-hole needs --fill or --clean"),
        (f"{TO} --fill-noisy", "--fill-noisy needs --fill"),
        (f"{TO} --fill --clean", "give one of --fill and --clean"),
        (f"{TO} --fill --clean-noise", "--clean-noise needs --clean"),
        (f"{TO} --fill --levels 2", "--levels is for fairing"),
        (f"{TO} --fill --largest-hole -2", "is not a number from 0"),
        (f"{TO} --fill --fill-density -1", "from 0 to 100"),
        ("in.obj out.step --fill", "STEP"),
        (f"{TO} --clean --fill-noisy", "--fill-noisy needs --fill"),
        (f"{TO} --clean --energy thin_plate", "--energy is for fairing, and --clean does not"),
        (f"{TO} --clean --clean-islands 2", "from 0 to 1"),
        (f"{TO} --cage c.obj", "--cage needs --fit"),
        ("--fit in.obj out.obj --cage cage.dwg", "no cage"),
        ("--fit in.obj out.obj --energy total_curvature", "--energy is not for"),
        ("--fit in.obj out.obj --cage c.obj --cage-faces 9", "give one of"),
        ("--fit in.obj out.obj --tolerance 0", "must be over 0"),
    ],
)
def test_wrong_usage_is_two(words, said, capfd):
    write_obj("in.obj")
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


def test_an_interruption_ends_all_and_is_reported(monkeypatch):
    write_obj("a.obj")
    write_obj("b.obj")
    write_obj("c.obj")
    after_first = iter([False, True])

    class Interrupted(one_file.Job):
        def compute(self, **watchers):
            if next(after_first):
                signal.raise_signal(signal.SIGINT)
            super().compute(**watchers)

    monkeypatch.setattr(one_file, "Job", Interrupted)
    code, records = entries("a.obj", "b.obj", "c.obj", "out/")
    assert code == command.INTERRUPTED
    assert [entry["status"] for entry in records] == ["done", "cancelled", "not_run"]
    assert [path.name for path in Path("out").iterdir()] == ["a.obj"]


def test_a_fault_of_ours_spares_the_other_files(monkeypatch, capfd):
    write_obj("a.obj")
    write_obj("b.obj")
    faults = iter([True, False])

    class Faulty(one_file.Job):
        def warnings(self):
            if next(faults):
                raise AttributeError("oops")
            return super().warnings()

    monkeypatch.setattr(one_file, "Job", Faulty)
    code, (a, b) = entries("a.obj", "b.obj", "out/")
    assert (code, a["error"]["code"], b["status"]) == (1, "INTERNAL", "done")
    assert "oops" in capfd.readouterr().err
