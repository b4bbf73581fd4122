# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes Blender's repository of the zips, for any static host: a listing for Blender, and a page to drag zips from."""

import shutil
from pathlib import Path

from layout import ROOT
from real_blender import RealBlender
from shell import run

PAGE = ROOT / "build_tools" / "repository_page.html"
LISTING = "index.json"


def generate(blender: RealBlender, zips: list[Path], folder: Path) -> None:
    """Fills `folder`, which is made again, with the zips, the listing and the page."""
    shared = blender.exchange / "repository"
    shutil.rmtree(shared, ignore_errors=True)
    shared.mkdir()
    shared.chmod(0o777)
    for path in zips:
        shutil.copy(path, shared)
    page = shutil.copy(PAGE, blender.exchange)
    words = ["--html", "--html-template", blender.seen(Path(page))]
    command = ["--command", "extension", "server-generate", *words]
    run(*blender.headless(*command, "--repo-dir", blender.seen(shared)))
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for path in (*zips, shared / LISTING, shared / "index.html"):
        shutil.copy(path, folder)
