# SPDX-License-Identifier: GPL-3.0-or-later
"""The installed wheel needs nothing but itself, and has the right version and licences."""

import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest
from wheel_version import manifest_version

WHEEL = metadata.distribution("discrete-fairing")


@pytest.mark.skipif(sys.platform != "linux", reason="looks into Linux's table of loaded libraries")
def test_libraries_are_loaded_from_the_wheel():
    code = "import discrete_fairing; print(open('/proc/self/maps').read())"
    lines = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout
    loaded = {line.split()[-1] for line in lines.splitlines() if "OpenMesh" in line}
    site = str(WHEEL.locate_file(""))
    assert loaded and all(path.startswith(site) for path in loaded), loaded


def test_octahedron():
    script = Path(__file__).with_name("octahedron.py")
    subprocess.run([sys.executable, script], check=True)


def test_version_is_the_manifests():
    assert WHEEL.version.partition("+")[0] == manifest_version()


def test_licences_are_carried():
    carried = {path.name for path in WHEEL.files if ".dist-info" in str(path)}
    assert {"LICENSE", "THIRD_PARTY_LICENSES.txt"} <= carried
