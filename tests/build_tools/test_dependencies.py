# SPDX-License-Identifier: GPL-3.0-or-later
"""Sources of Eigen, nanoflann and OpenMesh where none is installed. CMake is configured; nothing is compiled."""

import re
import shutil

import pytest
from layout import ROOT
from shell import output

# no machine's own libraries, and no network
NONE_HERE = ["-DFETCHCONTENT_TRY_FIND_PACKAGE_MODE=NEVER", "-DFETCHCONTENT_FULLY_DISCONNECTED=ON"]
FOLDERS = {"EIGEN3": "", "NANOFLANN": "include", "OPENMESH": "src"}  # where each has its headers

pytestmark = pytest.mark.skipif(shutil.which("g++") is None, reason="no compiler here")


def configured(folder, *variables):
    """Exit code and words of CMake in `folder`."""
    code, text = output("cmake", "-G", "Ninja", "-S", ROOT, "-B", folder, *variables)
    return code, " ".join(text.split())


def test_sources_in_folders_are_what_is_compiled_and_linked(tmp_path):
    places = {name: tmp_path / name for name in FOLDERS}
    core = places["OPENMESH"] / "src" / "OpenMesh" / "Core"
    for name, headers in FOLDERS.items():
        (places[name] / headers).mkdir(parents=True)
    for part in ("Mesh", "System", "Utils"):
        (core / part).mkdir(parents=True)
        (core / part / f"{part}.cc").touch()
    given = [f"-DFETCHCONTENT_SOURCE_DIR_{name}={place}" for name, place in places.items()]
    code, text = configured(tmp_path / "build", *NONE_HERE, *given)
    assert code == 0, text
    rules = (tmp_path / "build" / "build.ninja").read_text()
    wanted = {str(places[name] / headers) for name, headers in FOLDERS.items()}
    assert set(re.findall(r"-isystem (\S+)", rules)) == wanted
    assert all(str(core / part / f"{part}.cc") in rules for part in ("Mesh", "System", "Utils"))


def test_a_folder_without_sources_is_named(tmp_path):
    given = [f"-DFETCHCONTENT_SOURCE_DIR_{name}={tmp_path}" for name in FOLDERS]
    code, text = configured(tmp_path / "build", *NONE_HERE, *given)
    assert code == 1 and f"OpenMesh's sources are not in {tmp_path}" in text


def test_nothing_is_fetched_where_that_is_forbidden(tmp_path):
    code, text = configured(tmp_path, "-DDF_FETCH=OFF", "-DCMAKE_DISABLE_FIND_PACKAGE_OpenMesh=ON")
    assert code == 1 and "find_package for module OpenMesh" in text
