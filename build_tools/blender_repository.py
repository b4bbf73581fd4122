# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's repository of the zips: a listing that Blender reads, and a page to drag from, for any static host.

Blender writes both. What depends on the clock or on the order of a folder is settled after it, so that the same
zips give the same bytes.
"""

import json
import re
import shutil
import time
import zipfile
from pathlib import Path

from layout import ROOT
from real_blender import RealBlender
from shell import run

PAGE = ROOT / "build_tools" / "repository_page.html"
LISTING = "index.json"
FIRST_DATE = 315532800  # of zip: 1980-01-01, in seconds since 1970
ROW = re.compile(r"^  <tr>\n    <td>.*?^  </tr>\n", re.MULTILINE | re.DOTALL)


def settle(path: Path, epoch: int) -> None:
    """Writes a zip anew, its entries in order of their names and all of one time, in seconds since 1970."""
    date = time.gmtime(max(epoch, FIRST_DATE))[:6]
    settled = path.with_suffix(".settled")
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(settled, "w") as new:
        for name in sorted(old.namelist()):
            entry = zipfile.ZipInfo(name, date)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o40755 << 16 | 0x10) if name.endswith("/") else 0o100644 << 16
            new.writestr(entry, old.read(name))
    settled.replace(path)


def settled_listing(text: str) -> str:
    """The listing with the zips in order of their names: Blender takes them as the folder gives them."""
    listing = json.loads(text)
    listing["data"].sort(key=lambda package: package["archive_url"])
    return json.dumps(listing, indent=2) + "\n"


def settled_page(text: str) -> str:
    """The page with the rows of its table in order, of which the address comes first."""
    rows = iter(sorted(row[0] for row in ROW.finditer(text)))
    return ROW.sub(lambda _: next(rows), text)


def generate(blender: RealBlender, zips: list[Path], folder: Path) -> None:
    """Fills `folder`, which is made anew, with the zips, the listing and the page."""
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
    for path in zips:
        shutil.copy(path, folder)
    for name, settled in ((LISTING, settled_listing), ("index.html", settled_page)):
        (folder / name).write_text(settled((shared / name).read_text("utf-8")), "utf-8")
