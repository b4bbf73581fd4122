# SPDX-License-Identifier: GPL-3.0-or-later
"""Outputs of the command line are whole, or as they were before."""

import os
import stat
import tempfile
from pathlib import Path

import pytest
from cli_files import materials_of, write_obj
from cli_runs import process, run

from addon.cli import files


def names():
    return sorted(path.name for path in Path().iterdir())


@pytest.mark.parametrize("kind", ["obj", "ply", "stl"])
@pytest.mark.parametrize("room", [0, 100, 1000])
def test_a_full_disk_leaves_the_old_file(kind, room):
    write_obj("in.obj")
    Path(f"out.{kind}").write_text("old")
    code, _, said = process("in.obj", f"out.{kind}", "--levels", 1, largest_file=room)
    assert code == 1, said
    assert f"out.{kind} cannot be written: " in said
    assert Path(f"out.{kind}").read_text() == "old" and names() == ["in.obj", f"out.{kind}"]


@pytest.mark.parametrize(
    "error, code", [(RuntimeError("Error: no space left."), 1), (KeyboardInterrupt(), 130)]
)
def test_an_exporter_that_fails_leaves_the_old_file(error, code, monkeypatch, capfd):
    write_obj("in.obj")
    Path("out.obj").write_text("old")

    def fail(**_arguments):
        raise error

    monkeypatch.setattr(files, "_write_obj", fail)
    assert run("in.obj", "out.obj") == code
    assert ("cannot be written: no space left." in capfd.readouterr().err) == (code == 1)
    assert Path("out.obj").read_text() == "old" and names() == ["in.obj", "out.obj"]


@pytest.mark.parametrize("named", [False, True])
def test_the_materials_of_an_obj_keep_its_name(named):
    write_obj("in.obj", materials=("red", "blue"))
    if named:  # and so they are replaced with it
        Path("out.mtl").write_text("old")
        Path("out.obj").write_text("# old\nmtllib out.mtl\nv 0 0 0\n")
    assert run("in.obj", "out.obj", "--levels", 1) == 0
    assert materials_of(Path("out.obj")) == Path("out.mtl")
    assert "newmtl red" in Path("out.mtl").read_text()
    assert Path("out.obj").read_text().count("\nf ") == 24
    assert names() == ["in.obj", "out.mtl", "out.obj"]


@pytest.mark.parametrize("kind", ["obj", "ply", "stl", "step"])
def test_no_link_leads_the_writing_astray(kind, monkeypatch):
    """Links are planted at all names, other than the output's own, that one can foresee."""
    write_obj("in.obj")
    Path("victim").write_text("kept")
    for name in (f".out.{os.getpid()}.part.{kind}", f"out.{kind}.part", f"out.{kind}~"):
        Path(name).symlink_to("victim")
    made = []
    whole = tempfile.mkdtemp

    def folder(**words):
        made.append(Path(whole(**words)))
        assert stat.S_IMODE(made[-1].stat().st_mode) == 0o700  # nobody else may plant a link there
        return str(made[-1])

    monkeypatch.setattr(tempfile, "mkdtemp", folder)
    assert run("in.obj", f"out.{kind}", "--levels", 3) == 0
    assert made and not any(path.exists() for path in made)
    assert Path("victim").read_text() == "kept" and not Path(f"out.{kind}").is_symlink()


@pytest.mark.parametrize("kind", ["obj", "ply", "stl", "step"])
def test_what_is_no_file_is_written_to_itself(kind):
    write_obj("in.obj")
    Path(f"out.{kind}").symlink_to(os.devnull)
    assert run("in.obj", f"out.{kind}", "--levels", 3) == 0
    assert not Path(os.devnull).is_file() and Path(f"out.{kind}").is_symlink()
