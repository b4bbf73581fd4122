# SPDX-License-Identifier: GPL-3.0-or-later
"""The Debian packages that the project needs."""

import shutil

from shell import DevError, as_root, output, run, say

NATIVE = ["g++", "ccache", "libopenmesh-dev", "libeigen3-dev"]
NATIVE += ["libnanoflann-dev", "libgtest-dev", "libsuitesparse-dev"]
PYTHON = ["python3-venv", "python3-dev"]
# the bpy wheel loads these at import; the last ones are for drawing without a screen
BPY = ["libgl1", "libegl1", "libgl1-mesa-dri", "libice6", "libsm6", "libx11-6", "libxext6"]
BPY += ["libxfixes3", "libxi6", "libxkbcommon0", "libxrender1", "libxt6", "libxxf86vm1"]
BPY += ["libuuid1", "libopengl0", "libgomp1", "xvfb"]
REAL_BLENDER = ["mmdebstrap"]

ALL = NATIVE + PYTHON + BPY + REAL_BLENDER
# for the benchmarks only: programs to compare with, and a BLAS that is fast for CHOLMOD
BENCHMARKS = ["libcgal-dev", "libopenblas0-pthread"]
PAGES = ["libjs-three"]
SITE = ["chromium", "fonts-dejavu-core"]


def missing(packages: list[str]) -> list[str]:
    """The packages that are not installed, nor provided by another one (libxt6 by trixie's libxt6t64)."""
    _, listing = output("dpkg-query", "-W", "-f", "${db:Status-Status} ${Package}, ${Provides}\n")
    lines = [line.split(" ", 1) for line in listing.splitlines()]
    names = [names for status, names in lines if status == "installed"]
    installed = {entry.split()[0] for line in names for entry in line.split(",") if entry.strip()}
    return [package for package in packages if package not in installed]


def install(packages: list[str] = ALL) -> None:
    """Installs missing packages; returns at once if there are none."""
    if shutil.which("dpkg-query") is None:
        raise DevError(
            "this is no Debian: install " + " ".join(packages) + " or what they are called here."
        )
    wanted = missing(packages)
    if not wanted:
        return
    say("system packages: " + " ".join(wanted))
    quiet = ["env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-qq", "-o", "Dpkg::Use-Pty=0"]
    # an unrelated source without connection must not stop this: install reports missing packages
    run(*as_root(*quiet, "update"), check=False)
    run(*as_root(*quiet, "install", "--yes", "--no-install-recommends", *wanted))
