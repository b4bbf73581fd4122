# SPDX-License-Identifier: GPL-3.0-or-later
"""Cross compilation without a compiler: names, pinned sources and the packing of wheels."""

import hashlib
import io
import shutil
import tarfile
import zipfile

import extension
import pytest
from cross import python_parts, sources, wheels
from cross.sources import Source
from cross.targets import TARGETS, target_named
from shell import DevError
from wheel_version import manifest_version


@pytest.mark.parametrize("target", TARGETS, ids=lambda target: target.name)
def test_blender_knows_a_target_by_its_wheel_tag(target, tmp_path):
    wheel = tmp_path / f"discrete_fairing-1-cp313-cp313-{target.wheel_tag}.whl"
    assert extension.platform(wheel) == target.name


@pytest.mark.parametrize(
    ("name", "suffix"),
    [
        ("windows-x64", ".cp313-win_amd64.pyd"),
        ("linux-x64", ".cpython-313-x86_64-linux-gnu.so"),
        ("linux-arm64", ".cpython-313-aarch64-linux-gnu.so"),
        ("macos-arm64", ".cpython-313-darwin.so"),
    ],
)
def test_a_module_is_called_as_its_python_looks_for_it(name, suffix):
    assert target_named(name).suffix("cp313") == suffix


def source_of(path, texts):
    """A source whose archive, at `path`, has these files."""
    with tarfile.open(path, "w") as archive:
        for name, text in texts.items():
            entry = tarfile.TarInfo(name)
            entry.size = len(text)
            archive.addfile(entry, io.BytesIO(text.encode()))
    return Source(path.stem, path.name, hashlib.sha256(path.read_bytes()).hexdigest())


@pytest.fixture
def served(tmp_path, monkeypatch):
    """A source with its archive on this machine."""
    monkeypatch.setattr(sources, "FOLDER", tmp_path / "cache")
    monkeypatch.setattr(sources, "debian", lambda file, to: shutil.copy(tmp_path / file, to))
    return source_of(tmp_path / "thing.tar", {"thing/wanted.h": "1", "thing/other.c": "2"})


def test_only_what_is_wanted_is_unpacked(served):
    folder = served.unpacked(lambda name: name.endswith(".h"))
    assert [path.name for path in (folder / "thing").iterdir()] == ["wanted.h"]
    assert sources.only_folder(folder) == folder / "thing"


def test_another_file_than_the_pinned_one_is_refused(served):
    other = Source(served.name, served.file, "0" * 64)
    with pytest.raises(DevError, match="hash"):
        other.unpacked()
    assert not other.archive.exists() and not (sources.FOLDER / "thing").exists()


def test_a_source_out_of_reach_says_where_to_put_it(served):
    gone = Source("gone", "gone.tar", "0" * 64)
    with pytest.raises(DevError, match="by hand"):
        gone.fetch()


def test_the_import_library_is_of_the_right_python():
    lines = python_parts.definition("cp313").splitlines()
    assert lines[0] == "LIBRARY python313.dll"
    names = [line.strip() for line in lines[2:]]
    assert {"PyErr_SetString", "PyExc_RuntimeError", "_Py_Dealloc"} <= set(names)
    assert all(name.startswith(("Py", "_Py")) for name in names)
    assert names == sorted(set(names))


@pytest.fixture(scope="module")
def packed(tmp_path_factory):
    """A wheel of a module that is none."""
    folder, staged = tmp_path_factory.mktemp("wheel"), tmp_path_factory.mktemp("staged")
    module = folder / "_native.cp311-win_amd64.pyd"
    module.write_bytes(b"MZ")
    wheels.stage(staged)
    return wheels.pack(staged, module, "cp311-cp311-win_amd64", folder)


def test_a_packed_wheel_is_named_and_tagged_alike(packed):
    assert packed.name.startswith(f"discrete_fairing-{manifest_version()}")
    assert packed.name.endswith("-cp311-cp311-win_amd64.whl")
    with zipfile.ZipFile(packed) as archive:
        names = archive.namelist()
        (name,) = (name for name in names if name.endswith(".dist-info/WHEEL"))
        lines = archive.read(name).decode().splitlines()
    assert [line for line in lines if line.startswith("Tag:")] == ["Tag: cp311-cp311-win_amd64"]
    assert "Root-Is-Purelib: false" in lines
    assert {"discrete_fairing/__init__.py", "discrete_fairing/_native.cp311-win_amd64.pyd"} <= set(
        names
    )
    assert not any("__pycache__" in name for name in names)
