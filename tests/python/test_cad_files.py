# SPDX-License-Identifier: GPL-3.0-or-later
"""Files for CAD are whole or not there: after any failure the old one stays, and nothing is left
beside it."""

import os
import stat
from contextlib import contextmanager
from pathlib import Path
from threading import Thread

import control_meshes
import discrete_fairing as df
import pytest

resource = pytest.importorskip("resource", reason="Windows has neither such limits nor pipes")

CURVED = {"energy": "total_curvature"}
WRITERS = [pytest.param(df.write_step, id="step")]
if df.can_write_3dm():
    WRITERS.append(pytest.param(df.write_3dm, id="3dm"))
every_writer = pytest.mark.parametrize("write", WRITERS)


@pytest.fixture(scope="module")
def cube():
    return df.fit_patches(*control_meshes.cube(), levels=4, **CURVED)


@pytest.fixture
def old(tmp_path):
    """A file that is there already."""
    path = tmp_path / "a.file"
    path.write_text("old")
    return path


def only(path):
    return list(path.parent.iterdir()) == [path]


@contextmanager
def full_disk():
    """Inside the `with` no file may be longer than this, nor may the log of the tests; Python's own
    files are buffered, so the last bytes fail at the end.
    """
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_surface_that_is_refused_leaves_no_file(tmp_path):
    """What a caller writes in one line."""
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.02, 0, 0.02), (0.02, 1, 0.02)]
    with pytest.raises(df.FairingError) as caught:
        df.write_step(tmp_path / "a.step", df.fit_patches(points, [(0, 1, 2, 3), (1, 4, 5, 2)]))
    assert caught.value.code == "UNRESOLVED"
    assert not list(tmp_path.iterdir())


@every_writer
def test_a_full_disk_leaves_the_old_file(write, cube, old):
    with pytest.raises(OSError) as caught, full_disk():
        write(old, cube)
    assert caught.value.filename == str(old) and caught.value.strerror
    assert old.read_text() == "old" and only(old)


@every_writer
def test_a_full_disk_leaves_no_part_of_a_new_file(write, cube, tmp_path):
    with pytest.raises(OSError), full_disk():
        write(tmp_path / "a.file", cube)
    assert not list(tmp_path.iterdir())


@every_writer
def test_a_folder_without_permission(write, cube, old):
    """For root, too: as somebody who has no rights there."""
    user = os.geteuid()
    old.parent.chmod(0o555)
    os.seteuid(user or 65534)
    try:
        with pytest.raises(PermissionError) as caught:
            write(old, cube)
    finally:
        os.seteuid(user)
        old.parent.chmod(0o755)
    assert caught.value.filename == str(old)
    assert old.read_text() == "old" and only(old)


@every_writer
def test_a_folder_that_is_missing_is_named(write, cube, tmp_path):
    with pytest.raises(FileNotFoundError) as caught:
        write(tmp_path / "none" / "a.file", cube)
    assert caught.value.filename == str(tmp_path / "none" / "a.file")


@every_writer
def test_a_folder_in_the_place_of_the_file(write, cube, tmp_path):
    (tmp_path / "a.file").mkdir()
    with pytest.raises(OSError) as caught:
        write(tmp_path / "a.file", cube)
    assert caught.value.filename == str(tmp_path / "a.file")
    assert (tmp_path / "a.file").is_dir() and only(tmp_path / "a.file")


def test_an_interruption_midway(cube, old, monkeypatch):
    def stop(_self):
        raise KeyboardInterrupt

    monkeypatch.setattr("discrete_fairing.step._Writer.end", stop)
    with pytest.raises(KeyboardInterrupt):
        df.write_step(old, cube)
    assert old.read_text() == "old" and only(old)


@every_writer
def test_a_link_stays_one(write, cube, old):
    old.chmod(0o640)
    link = old.with_name("link")
    link.symlink_to(old)
    write(link, cube)
    assert link.is_symlink() and old.stat().st_size > 1000
    assert stat.S_IMODE(old.stat().st_mode) == 0o640


def test_a_pipe_is_written_to_itself(cube, tmp_path):
    pipe, found = tmp_path / "pipe", []
    os.mkfifo(pipe)
    reader = Thread(target=lambda: found.append(pipe.read_text()))
    reader.start()
    df.write_step(pipe, cube)
    reader.join()
    assert found[0].endswith("END-ISO-10303-21;\n") and only(pipe)


@every_writer
def test_a_long_name_is_a_name(write, cube, tmp_path):
    path = tmp_path / ("n" * 250 + ".step")
    write(path, cube)
    assert only(path)


@every_writer
@pytest.mark.parametrize(
    "options",
    [{"unit": "mile"}, {"scale": 0}, {"names": ["a", "b"]}, {"colours": (2, 0, 0)}],
    ids=str,
)
def test_bad_options(write, cube, old, options):
    with pytest.raises(df.FairingError) as caught:
        write(old, cube, **options)
    assert caught.value.code == "BAD_OPTION"
    assert Path(old).read_text() == "old" and only(old)
