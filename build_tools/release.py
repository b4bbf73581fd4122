# SPDX-License-Identifier: GPL-3.0-or-later
"""A release as a folder that any static host can serve: Blender's repository of the zips, wheels, source, site, sums.

Every time in it is that of the commit, so that the same commit and tools give the same bytes.
"""

import hashlib
import os
import re
import shutil
import time
import zipfile
from pathlib import Path

import extension
import site_pages
from layout import OUT, ROOT, VENV_PYTHON
from real_blender import RealBlender, places
from shell import DevError, output, run, say
from stamp import alone
from wheel_version import manifest_version

RELEASE = OUT / "release"
REPOSITORY = "blender"
SUMS = "SHA256SUMS"
BUILD_SDIST = "import sys, scikit_build_core.build as b; b.build_sdist(sys.argv[1])"
FIRST_DATE = 315532800  # of zip: 1980-01-01, in seconds since 1970


def commit_time() -> int:
    """Seconds since 1970: SOURCE_DATE_EPOCH where it is set, else the time of the commit."""
    if given := os.environ.get("SOURCE_DATE_EPOCH"):
        return int(given)
    code, text = output("git", "log", "-1", "--format=%ct")
    if code != 0:
        raise DevError("a release is made of a git commit, or with SOURCE_DATE_EPOCH set.")
    return int(text)


def settle(path: Path, epoch: int) -> None:
    """Writes a zip anew, its entries in order of their names and all of one time."""
    date = time.gmtime(max(epoch, FIRST_DATE))[:6]
    settled = path.with_suffix(".settled")
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(settled, "w") as new:
        for name in sorted(old.namelist()):
            entry = zipfile.ZipInfo(name, date)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o40755 << 16 | 0x10) if name.endswith("/") else 0o100644 << 16
            new.writestr(entry, old.read(name))
    settled.replace(path)


def notes(changelog: str) -> str:
    """The newest section of the changelog, without its heading."""
    sections = re.split(r"^## .*\n", changelog, flags=re.MULTILINE)
    if len(sections) < 2 or not sections[1].strip():
        raise DevError("CHANGELOG.md has no section to take release notes from.")
    return sections[1].strip() + "\n"


def serve_by(blender: RealBlender, zips: list[Path], folder: Path, epoch: int) -> None:
    """Blender's own listing of the zips, and a page to drag from, in a folder that is not there yet."""
    shared = blender.exchange / REPOSITORY
    shutil.rmtree(shared, ignore_errors=True)
    shared.mkdir()
    shared.chmod(0o777)
    for path in zips:
        shutil.copy(path, shared)
    command = ["--command", "extension", "server-generate", "--html"]
    run(*blender.headless(*command, "--repo-dir", blender.seen(shared)))
    shutil.copytree(shared, folder)
    page = folder / "index.html"
    day = time.strftime("%Y-%m-%d", time.gmtime(epoch))
    page.write_text(
        re.sub(r"Built [\d-]+, [\d:]+", f"Built {day}", page.read_text("utf-8")), "utf-8"
    )


def sums(folder: Path) -> str:
    """Hash and name of every file, as `sha256sum --check` reads them."""
    files = sorted(path for path in folder.rglob("*") if path.is_file() and path.name != SUMS)
    return "".join(
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.relative_to(folder)}\n"
        for path in files
    )


def build(zips: list[list[Path]]) -> Path:
    """The release's folder, with a zip for each list of wheels."""
    epoch = commit_time()
    os.environ["SOURCE_DATE_EPOCH"] = str(epoch)  # for Sphinx and the sdist
    packed = extension.build_all(zips)
    shutil.rmtree(RELEASE, ignore_errors=True)
    (RELEASE / "wheels").mkdir(parents=True)
    for path in packed:
        settle(path, epoch)
    with alone("blender"):
        serve_by(next(iter(places().values()))(), packed, RELEASE / REPOSITORY, epoch)
    for wheel in (wheel for wheels in zips for wheel in wheels):
        shutil.copy(wheel, RELEASE / "wheels")
    run(VENV_PYTHON, "-c", BUILD_SDIST, RELEASE)
    shutil.copytree(site_pages.build(), RELEASE / "site")
    (RELEASE / "NOTES.md").write_text(notes((ROOT / "CHANGELOG.md").read_text("utf-8")), "utf-8")
    (RELEASE / SUMS).write_text(sums(RELEASE), "utf-8")
    say(f"release {manifest_version()}")
    return RELEASE
