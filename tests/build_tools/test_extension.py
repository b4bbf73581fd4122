# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder staged for Blender, with wheels that are empty but for their names."""

import tomllib
from pathlib import Path

import extension
import pytest
from shell import DevError
from wheel_version import manifest_version

VERSION = manifest_version()


def wheel(tags, version=VERSION):
    return Path(f"discrete_fairing-{version}-{tags}.whl")


LINUX = wheel("cp311-cp311-manylinux_2_35_x86_64", f"{VERSION}+g0123456789")


@pytest.fixture
def staged(tmp_path):
    """A folder staged with a wheel of a development build."""
    path = tmp_path / LINUX
    path.write_bytes(b"")
    extension.stage([path], tmp_path / "staged")
    return tmp_path / "staged"


@pytest.mark.parametrize(
    ("tag", "platform"),
    [
        ("linux_x86_64", "linux-x64"),
        ("manylinux_2_28_x86_64", "linux-x64"),
        ("manylinux_2_27_x86_64.manylinux_2_28_x86_64", "linux-x64"),
        ("manylinux2014_aarch64.manylinux_2_17_aarch64", "linux-arm64"),
        ("macosx_13_0_x86_64", "macos-x64"),
        ("macosx_11_0_arm64", "macos-arm64"),
        ("win_amd64", "windows-x64"),
        ("win_arm64", "windows-arm64"),
    ],
)
def test_platform_of_a_wheel(tag, platform):
    assert extension.platform(wheel(f"cp313-cp313-{tag}")) == platform


@pytest.mark.parametrize("tag", ["win32", "macosx_11_0_universal2", "musllinux_1_2_x86_64", "any"])
def test_other_platforms_are_refused(tag):
    with pytest.raises(DevError, match="platform"):
        extension.platform(wheel(f"cp313-cp313-{tag}"))


@pytest.mark.parametrize(("tag", "end"), [("cp311", "5.1.0"), ("cp313", None), ("cp314", None)])
def test_staged_manifest(tag, end):
    manifest = tomllib.loads(extension.staged_manifest([wheel(f"{tag}-{tag}-win_amd64")]))
    assert manifest["version"] == VERSION
    assert manifest["platforms"] == ["windows-x64"]
    assert manifest["wheels"] == [f"./wheels/discrete_fairing-{VERSION}-{tag}-{tag}-win_amd64.whl"]
    assert manifest["blender_version_min"] == "4.3.0"
    assert manifest.get("blender_version_max") == end


def test_one_zip_for_several_pythons():
    wheels = [wheel(f"{tag}-{tag}-win_amd64") for tag in ("cp311", "cp313")]
    manifest = tomllib.loads(extension.staged_manifest(wheels))
    assert extension.name(wheels) == f"discrete_fairing-{VERSION}-windows_x64"
    assert manifest["wheels"] == [f"./wheels/{path.name}" for path in wheels]
    assert manifest["platforms"] == ["windows-x64"]
    # Blender 4.2.0 would install the wrong one
    assert manifest["blender_version_min"] == "4.3.0"
    assert "blender_version_max" not in manifest


@pytest.mark.parametrize(
    "tags",
    [
        ("cp311-cp311-win_amd64", "cp311-cp311-macosx_11_0_arm64"),
        ("cp311-cp311-manylinux_2_28_x86_64", "cp311-cp311-linux_x86_64"),
    ],
)
def test_wheels_that_make_no_zip_are_refused(tags):
    with pytest.raises(DevError, match="one platform, one a Python"):
        extension.name([wheel(tag) for tag in tags])


def test_wheels_of_a_folder_are_sorted_by_platform(tmp_path):
    tags = ["cp311-cp311-win_amd64", "cp313-cp313-win_amd64", "cp311-cp311-macosx_11_0_arm64"]
    for tag in tags:
        (tmp_path / wheel(tag)).write_bytes(b"")
    names = [extension.name(wheels) for wheels in extension.wheels_in(tmp_path)]
    assert names == [
        f"discrete_fairing-{VERSION}-cp311-macos_arm64",
        f"discrete_fairing-{VERSION}-windows_x64",
    ]


def test_staged_folder(staged):
    manifest = tomllib.loads((staged / "blender_manifest.toml").read_text())
    assert all((staged / entry).is_file() for entry in manifest["wheels"])
    assert manifest["permissions"].keys() == {"files"}
    assert all((staged / name).is_file() for name in ("__init__.py", *extension.LICENCES))
    assert (staged / "LICENSE").read_text().strip().startswith("GNU GENERAL PUBLIC LICENSE")
    assert not list(staged.rglob("__pycache__"))


def test_a_wheel_of_another_version_is_not_staged(tmp_path):
    with pytest.raises(DevError, match="version"):
        extension.stage([wheel("cp311-cp311-win_amd64", "999.0.0")], tmp_path / "staged")


def test_two_wheels_for_one_place_are_refused(tmp_path):
    for version in (VERSION, f"{VERSION}+g0123456789"):
        (tmp_path / wheel("cp311-cp311-win_amd64", version)).write_bytes(b"")
    with pytest.raises(DevError, match="two wheels"):
        extension.wheels_in(tmp_path)


def test_an_empty_folder_of_wheels_is_refused(tmp_path):
    with pytest.raises(DevError, match="no wheel"):
        extension.wheels_in(tmp_path)
