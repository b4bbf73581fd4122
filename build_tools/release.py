# SPDX-License-Identifier: GPL-3.0-or-later
"""A release as a folder that any static host can serve: Blender's repository of the zips, wheels, source, site, samples, sums."""

import hashlib
import os
import re
import shutil
from pathlib import Path

import blender_repository
import components
import extension
import site_pages
from debian_root import ROOTS
from layout import OUT, ROOT, VENV_PYTHON
from python_environment import has_bpy
from real_blender import of_debian
from shell import DevError, output, run, say
from stamp import alone
from wheel_version import manifest_version

RELEASE = OUT / "release"
REPOSITORY = "blender"
SUMS = "SHA256SUMS"
COMPONENTS = "components.cdx.json"
BUILD_SDIST = "import sys, scikit_build_core.build as b; b.build_sdist(sys.argv[1])"


def commit_time() -> int:
    """Seconds since 1970: SOURCE_DATE_EPOCH where it is set, else the time of the commit."""
    if given := os.environ.get("SOURCE_DATE_EPOCH"):
        return int(given)
    code, text = output("git", "log", "-1", "--format=%ct")
    if code != 0:
        raise DevError("a release is made of a git commit, or with SOURCE_DATE_EPOCH set.")
    return int(text)


def notes(changelog: str) -> str:
    """The newest section of the changelog, without its heading."""
    sections = re.split(r"^## .*\n", changelog, flags=re.MULTILINE)
    if len(sections) < 2 or not sections[1].strip():
        raise DevError("CHANGELOG.md has no section to take release notes from.")
    return sections[1].strip() + "\n"


def sums(folder: Path) -> str:
    """Hash and name of every file, for `sha256sum --check`."""
    files = sorted(path for path in folder.rglob("*") if path.is_file() and path.name != SUMS)
    return "".join(
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.relative_to(folder)}\n"
        for path in files
    )


def add_samples(folder: Path) -> None:
    """A .blend file for each trade, written by the bpy module."""
    if has_bpy():
        run(VENV_PYTHON, ROOT / "examples" / "sample_files.py", folder)
    else:
        say("bpy exists for Python 3.11 only: the release has no sample files.")


def build(zips: list[list[Path]]) -> Path:
    """The release's folder, with a zip for each list of wheels."""
    epoch = commit_time()
    os.environ["SOURCE_DATE_EPOCH"] = str(epoch)  # for Sphinx and the sdist
    packed = extension.build_all(zips)
    shutil.rmtree(RELEASE, ignore_errors=True)
    (RELEASE / "wheels").mkdir(parents=True)
    with alone("blender"):
        blender_repository.generate(of_debian(ROOTS[0]), packed, RELEASE / REPOSITORY)
    for wheel in (wheel for wheels in zips for wheel in wheels):
        shutil.copy(wheel, RELEASE / "wheels")
    run(VENV_PYTHON, "-c", BUILD_SDIST, RELEASE)
    shutil.copytree(site_pages.build(), RELEASE / "site")
    add_samples(RELEASE / "samples")
    (RELEASE / COMPONENTS).write_text(components.listing(manifest_version(), epoch), "utf-8")
    (RELEASE / "NOTES.md").write_text(notes((ROOT / "CHANGELOG.md").read_text("utf-8")), "utf-8")
    (RELEASE / SUMS).write_text(sums(RELEASE), "utf-8")
    say(f"release {manifest_version()}")
    return RELEASE
