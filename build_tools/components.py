# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the list of components, CycloneDX 1.6 as JSON: the code that is compiled into a release's wheels."""

import json
import re
from datetime import UTC, datetime
from typing import Any
from uuid import NAMESPACE_URL, uuid5

from layout import ROOT
from shell import DevError

SOURCES, DEPENDENCIES = "build_tools/cross/sources.py", "cmake/dependencies.cmake"
ZIG = r"build_tools/requirements_zig.txt ziglang==([\d.]+)"
# as in THIRD_PARTY_LICENSES.txt: name, the file and pattern of the version in releases, licence, page, package
LIBRARIES = (
    ("OpenMesh", rf"{SOURCES} openmesh_([\d.]+)\.orig", "BSD-3-Clause")
    + ("https://www.graphics.rwth-aachen.de/software/openmesh/", "generic/openmesh"),
    ("Eigen", rf"{DEPENDENCIES} /eigen-([\d.]+)\.tar", "MPL-2.0")
    + ("https://eigen.tuxfamily.org", "generic/eigen"),
    ("nanoflann", rf"{DEPENDENCIES} /nanoflann/.*/v([\d.]+)\.tar", "BSD-2-Clause")
    + ("https://github.com/jlblancoc/nanoflann", "generic/nanoflann"),
    ("pybind11", r"build_tools/requirements.txt pybind11==([\d.]+)", "BSD-3-Clause")
    + ("https://github.com/pybind/pybind11", "pypi/pybind11"),
    ("LLVM's C++ library and compiler support", ZIG, "Apache-2.0 WITH LLVM-exception")
    + ("https://llvm.org", "generic/llvm-project"),
    ("mingw-w64's start-up code and support", ZIG, "ZPL-2.1")
    + ("https://www.mingw-w64.org", "generic/mingw-w64"),
)


def version_in(place: str) -> str:
    """The version in a file of the project, by the first match of the pattern."""
    file, _, pattern = place.partition(" ")
    found = re.search(pattern, (ROOT / file).read_text("utf-8"))
    if found is None:
        raise DevError(f"{file} names no version as {pattern}.")
    return f"of zig {found[1]}" if place == ZIG else found[1]  # of the two that zig brings


def component(name: str, version: str, licence: str, page: str, package: str) -> dict[str, Any]:
    """A component whose code is in the wheels; `package` is its type and name as a package, "pypi/pybind11"."""
    url = f"pkg:{package}@{version}" if version[0].isdigit() else f"pkg:{package}"
    return {
        "type": "library",
        "bom-ref": url,
        "name": name,
        "version": version,
        "licenses": [{"expression": licence}],
        "purl": url,
        "externalReferences": [{"type": "website", "url": page}] if page else [],
    }


def listing(version: str, epoch: int) -> str:
    """The list as JSON for a release of this version and time; it depends on nothing else."""
    ours = component("discrete-fairing", version, "GPL-3.0-or-later", "", "pypi/discrete-fairing")
    parts = [component(name, version_in(place), *others) for name, place, *others in LIBRARIES]
    refs = [part["bom-ref"] for part in parts]
    whole = {
        "$schema": "http://cyclonedx.org/schema/bom-1.6.schema.json",
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "serialNumber": uuid5(NAMESPACE_URL, f"{ours['purl']}#{epoch}").urn,
        "version": 1,
        "metadata": {
            "timestamp": datetime.fromtimestamp(epoch, UTC).isoformat(),
            "component": ours,
        },
        "components": parts,
        "dependencies": [{"ref": ours["bom-ref"], "dependsOn": refs}, *({"ref": r} for r in refs)],
    }
    return json.dumps(whole, indent=2) + "\n"
