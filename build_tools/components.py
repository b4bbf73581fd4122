# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of components, CycloneDX 1.6 as JSON: what is compiled into a release's wheels.

    python components.py VERSION EPOCH FILE

Run by a Python that has cyclonedx-python-lib. The list depends on its arguments alone: no clock, no random numbers.
"""

import re
import sys
from datetime import UTC, datetime
from pathlib import Path
from uuid import NAMESPACE_URL, uuid5

from cyclonedx.model import ExternalReference, ExternalReferenceType, XsUri
from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentType
from cyclonedx.model.license import LicenseExpression
from cyclonedx.output.json import JsonV1Dot6
from packageurl import PackageURL

ROOT = Path(__file__).resolve().parent.parent


def version_in(file: str, pattern: str) -> str:
    """The version that a file of the project names, the first match of `pattern`."""
    found = re.search(pattern, (ROOT / file).read_text("utf-8"))
    if found is None:
        raise SystemExit(f"components.py: {file} names no version as {pattern}")
    return found[1]


def library(name: str, version: str, licence: str, page: str, package: str) -> Component:
    """A library whose code is in the wheels; `package` is its type and name as a package, "pypi/pybind11"."""
    kind, _, called = package.partition("/")
    number = version if version[0].isdigit() else None
    url = PackageURL(kind, name=called, version=number)
    return Component(
        type=ComponentType.LIBRARY,
        name=name,
        version=version,
        bom_ref=str(url),
        purl=url,
        licenses=[LicenseExpression(licence)],
        external_references=[
            ExternalReference(type=ExternalReferenceType.WEBSITE, url=XsUri(page))
        ],
    )


def libraries() -> list[Component]:
    """What THIRD_PARTY_LICENSES.txt names, each with the version that releases are compiled with."""
    zig = version_in("build_tools/cross/sources.py", r"ziglang-([\d.]+)-")
    return [
        library(
            "OpenMesh",
            version_in("build_tools/cross/sources.py", r"openmesh_([\d.]+)\.orig"),
            "BSD-3-Clause",
            "https://www.graphics.rwth-aachen.de/software/openmesh/",
            "generic/openmesh",
        ),
        library(
            "Eigen",
            version_in("cmake/dependencies.cmake", r"/eigen-([\d.]+)\.tar"),
            "MPL-2.0",
            "https://eigen.tuxfamily.org",
            "generic/eigen",
        ),
        library(
            "nanoflann",
            version_in("cmake/dependencies.cmake", r"/nanoflann/.*/v([\d.]+)\.tar"),
            "BSD-2-Clause",
            "https://github.com/jlblancoc/nanoflann",
            "generic/nanoflann",
        ),
        library(
            "pybind11",
            version_in("build_tools/requirements.txt", r"pybind11==([\d.]+)"),
            "BSD-3-Clause",
            "https://github.com/pybind/pybind11",
            "pypi/pybind11",
        ),
        # of the two that zig brings, the version is zig's
        library(
            "LLVM's C++ library and compiler support",
            f"of zig {zig}",
            "Apache-2.0 WITH LLVM-exception",
            "https://llvm.org",
            "generic/llvm-project",
        ),
        library(
            "mingw-w64's start-up code and support",
            f"of zig {zig}",
            "ZPL-2.1",
            "https://www.mingw-w64.org",
            "generic/mingw-w64",
        ),
    ]


def listing(version: str, epoch: int) -> str:
    """The list as JSON, of a release of this version and time."""
    ours = Component(
        type=ComponentType.LIBRARY,
        name="discrete-fairing",
        version=version,
        bom_ref="discrete-fairing",
        purl=PackageURL("pypi", name="discrete-fairing", version=version),
        licenses=[LicenseExpression("GPL-3.0-or-later")],
    )
    parts = libraries()
    bom = Bom(components=parts, serial_number=uuid5(NAMESPACE_URL, f"{ours.purl}#{epoch}"))
    bom.metadata.component = ours
    bom.metadata.timestamp = datetime.fromtimestamp(epoch, UTC)
    bom.register_dependency(ours, parts)
    return JsonV1Dot6(bom).output_as_string(indent=2) + "\n"


if __name__ == "__main__":
    Path(sys.argv[3]).write_text(listing(sys.argv[1], int(sys.argv[2])), "utf-8")
