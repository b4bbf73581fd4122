# SPDX-License-Identifier: GPL-3.0-or-later
"""The site: the Markdown documents and the package's docstrings as pages, made by Sphinx.

The documents are staged as they lie in the project, so that the links between them hold in both places.
"""

import shutil
from pathlib import Path

import native_wheel
from layout import BUILD, CACHE, OUT, ROOT, VENV
from python_environment import STAMP as PYTHON_STAMP
from shell import run, say
from stamp import alone, fingerprint, is_fresh, leave
from wheel_version import manifest_version

REQUIREMENTS = ROOT / "build_tools" / "requirements_docs.lock"
TOOLS = CACHE / "site"  # a Python of its own: Sphinx's libraries stay out of .venv
TOOLS_STAMP = TOOLS / "stamp"
SOURCE = BUILD / "site"
SITE = OUT / "site"

STAGED = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "LICENSE", "THIRD_PARTY_LICENSES.txt"]
STAGED_FOLDERS = ["docs", "benchmarks/results"]


def install_tools() -> Path:
    """A Python with Sphinx that finds the package and NumPy in .venv; returns at once when it is as before."""
    value = fingerprint([REQUIREMENTS], PYTHON_STAMP.read_text())
    python = TOOLS / "bin" / "python"
    if not is_fresh(TOOLS_STAMP, value):
        say("Python environment of the site")
        run(VENV / "bin" / "python", "-m", "venv", "--clear", TOOLS)
        quiet = ["install", "--quiet", "--disable-pip-version-check"]
        run(python, "-m", "pip", *quiet, "--require-hashes", "--requirement", REQUIREMENTS)
        (packages,) = TOOLS.glob("lib/python*/site-packages")
        (shared,) = VENV.glob("lib/python*/site-packages")
        # a path file adds to the end: what Sphinx brings along goes first
        (packages / "shared.pth").write_text(f"{shared}\n")
        leave(TOOLS_STAMP, value)
    return python


def stage() -> None:
    """Lays the sources of the pages out anew."""
    shutil.rmtree(SOURCE, ignore_errors=True)
    shutil.copytree(ROOT / "docs" / "site", SOURCE)
    for name in STAGED:
        shutil.copy(ROOT / name, SOURCE)
    for name in STAGED_FOLDERS:
        shutil.copytree(ROOT / name, SOURCE / name, ignore=shutil.ignore_patterns("site"))


def build() -> Path:
    """The site's folder; a warning, as of a link that leads nowhere, is an error."""
    native_wheel.install()
    with alone("site"):
        python = install_tools()
        stage()
        shutil.rmtree(SITE, ignore_errors=True)
        options = ["--fail-on-warning", "--keep-going", "--fresh-env", "--builder", "html"]
        doctrees = ["--doctree-dir", BUILD / "site-doctrees"]
        command = [python, "-m", "sphinx", "--quiet", *options, *doctrees, SOURCE, SITE]
        run(*command, DF_VERSION=manifest_version())
    return SITE
