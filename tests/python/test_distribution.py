# SPDX-License-Identifier: GPL-3.0-or-later
"""What is installed is what this tree builds: one version, and a module that needs nothing from the
system."""

import re
import tomllib
from importlib.metadata import files, version
from pathlib import Path

MANIFEST = Path(__file__).resolve().parents[2] / "blender_manifest.toml"


def test_version_is_the_manifests():
    assert (
        version("discrete-fairing").split("+")[0] == tomllib.loads(MANIFEST.read_text())["version"]
    )


def test_tagline_is_what_blender_accepts():
    tagline = tomllib.loads(MANIFEST.read_text())["tagline"]
    assert len(tagline) <= 64 and tagline[-1].isalnum()


def test_wheel_carries_the_mesh_library_or_has_it_inside():
    """A library beside the module if the module asks for one; else it is linked in."""
    (module,) = (path for path in files("discrete-fairing") if path.match("_native.*.so"))
    asks = b"OpenMeshCore" in module.locate().read_bytes()
    names = [path.name for path in files("discrete-fairing")]
    assert asks == any(re.match(r"libOpenMeshCore\W.*so", name) for name in names), names
