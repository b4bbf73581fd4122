# SPDX-License-Identifier: GPL-3.0-or-later
"""Files for CAD are whole or not there: after any failure the old one stays, and nothing is left beside it."""

import os
import stat
from contextlib import contextmanager
from pathlib import Path

import control_meshes
import discrete_fairing as df
import numpy as np
import pytest
from refusing import refusal

resource = pytest.importorskip("resource", reason="Windows has neither such limits nor pipes")

CURVED = {"energy": "total_curvature"}


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
def failing(error, path):
    """The body fails with this error, which names the file; afterwards the folder holds what it held before."""

    def there():
        files = path.parent.glob("*")
        return {f: f.read_text() if f.is_file() and not f.is_symlink() else "" for f in files}

    before = there()
    with pytest.raises(error) as caught:
        yield caught
    assert there() == before
    assert error is KeyboardInterrupt or caught.value.filename == str(path)


@contextmanager
def full_disk():
    """In the body no file may grow longer than this; Python writes the last bytes at the end."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("name", ["a.file", "new.file"])
def test_a_full_disk_leaves_the_old_file_and_no_part_of_a_new_one(cube, old, name):
    path = old.with_name(name)
    with failing(OSError, path) as caught, full_disk():
        df.write_step(path, cube)
    assert caught.value.strerror


def test_a_folder_without_permission(cube, old):
    """Also for root, who takes the identity of a user without rights there."""
    user = os.geteuid()
    old.parent.chmod(0o555)
    with failing(PermissionError, old):
        os.seteuid(user or 65534)
        try:
            df.write_step(old, cube)
        finally:
            os.seteuid(user)
            old.parent.chmod(0o755)


def test_a_link_stays_one(cube, old):
    old.chmod(0o640)
    link = old.with_name("link")
    link.symlink_to(old)
    df.write_step(link, cube)
    assert link.is_symlink() and old.stat().st_size > 1000
    assert stat.S_IMODE(old.stat().st_mode) == 0o640


BAD = {
    "unit": ["mile", ["mm"], None],
    "scale": [0, float("nan"), 1e308, "large"],
    "names": [["a", "b"], 3, [3], [b"a"]],
    "colours": [(2, 0, 0), "red", ["1", "0", "0"], [(0, 0, 0), (0, 0)], ..., (float("nan"), 0, 0)],
}


@pytest.mark.parametrize("name, value", [(k, v) for k in BAD for v in BAD[k]], ids=str)
def test_bad_options(cube, old, name, value):
    error = refusal(df.write_step, old, cube, **{name: value})
    assert error.code == "BAD_OPTION" and name in str(error)
    assert Path(old).read_text() == "old" and only(old)


@pytest.mark.parametrize("patches", [None, 3, [None], ["a"]], ids=str)
def test_what_is_no_patches_is_refused(patches, old):
    with pytest.raises(df.FairingError, match="patches"):
        df.write_step(old, patches)
    assert old.read_text() == "old" and only(old)


@pytest.mark.parametrize("path", [None, 3, "", "a\0b", b"a\0", "\ud800", ...], ids=repr)
def test_what_names_no_file_is_refused(cube, path):
    with pytest.raises(df.FairingError, match="it must be the name of a file") as caught:
        df.write_step(path, cube)
    assert caught.value.code == "BAD_OPTION"


@pytest.mark.parametrize(
    "matrix",
    [np.full((4, 4), np.nan), np.eye(3), np.diag([1, 1, np.inf, 1]), "turned", None, [[1], [1, 2]]],
    ids=["nan", "3 x 3", "inf", "text", "none", "ragged"],
)
def test_patches_are_moved_by_finite_matrices_alone(cube, matrix):
    with pytest.raises(df.FairingError, match="matrix") as caught:
        cube.transformed(matrix)
    assert caught.value.code == "BAD_SHAPE"


def test_a_large_part_keeps_looking_outward(cube, tmp_path):
    """Its volume overflows; its coordinates do not."""
    large = cube.transformed(np.diag([1e150, 1e150, 1e150, 1]))
    df.write_step(tmp_path / "a.file", large)
    with pytest.raises(df.FairingError, match="finite coordinates"):
        df.write_step(tmp_path / "b.file", large, scale=1e200)
    assert only(tmp_path / "a.file")
