# SPDX-License-Identifier: GPL-3.0-or-later
"""Outputs of the command line: whole, or as they were before."""

import os
from pathlib import Path

import pytest
from cli_files import write_obj
from cli_runs import entries, run

from addon.cli import files
from addon.cli.places import BadPlaces, places
from addon.cli.replacing import replacing, why_incomplete


@pytest.fixture(autouse=True)
def own_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def names():
    return sorted(path.name for path in Path().iterdir())


def cut_short(share):
    """An exporter whose disk is full after a part of the file."""
    whole = files._export

    def export(path):
        def short(**_arguments):
            content = path.read_bytes()
            path.write_bytes(content[: int(share * len(content))])

        try:
            whole(path)
        finally:
            short()
        reason = why_incomplete(path, 6 * 4, 6 * 4 * 4)
        if reason:
            raise files._NotWritten(reason)

    return export


@pytest.mark.parametrize("kind", ["obj", "ply", "stl"])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.95])
def test_a_full_disk_leaves_the_old_file(kind, share, monkeypatch):
    write_obj("in.obj")
    Path(f"out.{kind}").write_text("old")
    monkeypatch.setattr(files, "_export", cut_short(share))
    code, (entry,) = entries("in.obj", f"out.{kind}", "--levels", 1)
    assert (code, entry["error"]["code"]) == (1, "UNWRITABLE")
    assert Path(f"out.{kind}").read_text() == "old"
    assert names() == sorted(["in.obj", f"out.{kind}", "report.json"])


@pytest.mark.parametrize("kind", ["obj", "ply", "stl"])
def test_a_whole_file_is_seen_as_whole(kind):
    write_obj("in.obj", names=("Left", "Right"))
    assert run("in.obj", f"out.{kind}", "--levels", 1) == 0
    assert names() == sorted(["in.obj", f"out.{kind}"])


def test_an_exporter_that_fails_leaves_the_old_file(monkeypatch):
    write_obj("in.obj")
    Path("out.obj").write_text("old")

    def fail(**_arguments):
        raise RuntimeError("Error: no space left.")

    monkeypatch.setattr(files, "_write_obj", fail)
    code, (entry,) = entries("in.obj", "out.obj")
    assert code == 1 and entry["error"]["message"].endswith("cannot be written: no space left.")
    assert Path("out.obj").read_text() == "old" and len(names()) == 3


def test_an_interruption_leaves_the_old_file(monkeypatch):
    write_obj("in.obj")
    Path("out.obj").write_text("old")

    def interrupt(**_arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr(files, "_write_obj", interrupt)
    assert run("in.obj", "out.obj") == 130
    assert Path("out.obj").read_text() == "old" and names() == ["in.obj", "out.obj"]


def test_the_materials_of_an_obj_keep_its_name():
    write_obj("in.obj", materials=("red", "blue"))
    Path("out.mtl").write_text("old")
    assert run("in.obj", "out.obj", "--levels", 1) == 0
    assert "newmtl red" in Path("out.mtl").read_text()
    lines = Path("out.obj").read_text().splitlines()
    assert [line for line in lines if line.startswith("mtllib")] == ["mtllib out.mtl"]
    assert sum(line.startswith("f ") for line in lines) == 24
    assert names() == ["in.obj", "out.mtl", "out.obj"]


def test_a_link_stays_a_link():
    write_obj("in.obj")
    Path("deep").mkdir()
    Path("out.obj").symlink_to(Path("deep") / "real.obj")
    assert run("in.obj", "out.obj", "--levels", 1) == 0
    assert Path("out.obj").is_symlink() and Path("deep/real.obj").stat().st_size > 100


def test_what_is_no_file_is_written_to_itself():
    with replacing(Path(os.devnull)) as part:
        assert part == Path(os.devnull)


def test_patterns_are_expanded():
    for name in ("b.obj", "a.obj", "c.ply"):
        Path(name).write_text("v 0 0 0")
    assert [str(place.source) for place in places(["*.obj", "c.ply"], "out/")] == [
        "a.obj",
        "b.obj",
        "c.ply",
    ]
    Path("[x].obj").write_text("v 0 0 0")
    assert [str(place.source) for place in places(["[x].obj"], "out/")] == ["[x].obj"]
    with pytest.raises(BadPlaces, match="No file is called like"):
        places(["*.stl"], "out/")
