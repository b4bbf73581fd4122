# SPDX-License-Identifier: GPL-3.0-or-later
"""The site: the Markdown documents and the package's docstrings as pages, made by Sphinx.

The documents keep their places in the project, so that links between them work in both.
"""

import shutil
from pathlib import Path

import native_wheel
import python_environment
import site_models
from layout import BUILD, OUT, ROOT
from shell import run
from stamp import alone
from wheel_version import manifest_version

SOURCE = BUILD / "site"
SITE = OUT / "site"
LOCK = ROOT / "build_tools" / "requirements_docs.lock"

STAGED = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "LICENSE", "THIRD_PARTY_LICENSES.txt"]
STAGED_FOLDERS = ["docs", "benchmarks/results"]


def stage() -> None:
    """Copies the sources of the pages."""
    shutil.rmtree(SOURCE, ignore_errors=True)
    shutil.copytree(ROOT / "docs" / "site", SOURCE)
    for name in STAGED:
        shutil.copy(ROOT / name, SOURCE)
    for name in STAGED_FOLDERS:
        shutil.copytree(ROOT / name, SOURCE / name, ignore=shutil.ignore_patterns("site", "tables"))
    site_models.add_three(SOURCE / "_static")
    site_models.add_models(SOURCE / "_static")


def build() -> Path:
    """Builds the site's folder; a warning, such as for a broken link, is an error."""
    native_wheel.install()
    with alone("site"):
        python = python_environment.install_tool("site", LOCK)
        stage()
        shutil.rmtree(SITE, ignore_errors=True)
        options = ["--fail-on-warning", "--keep-going", "--fresh-env", "--builder", "html"]
        doctrees = ["--doctree-dir", BUILD / "site-doctrees"]
        command = [python, "-m", "sphinx", "--quiet", *options, *doctrees, SOURCE, SITE]
        run(*command, DF_VERSION=manifest_version())
    return SITE
