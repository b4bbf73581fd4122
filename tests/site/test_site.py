# SPDX-License-Identifier: GPL-3.0-or-later
"""The site is built without a warning, works without a network, and is drawn by a real browser, wide and narrow."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SITE = ROOT / "out" / "site"
SCREENSHOTS = ROOT / "out" / "screenshots" / "site"
PNG_SIZE = slice(16, 24)  # width and height in a PNG's first chunk


@pytest.fixture(scope="module")
def site():
    """The folder that `dev.py docs` makes; a warning makes that fail."""
    subprocess.run(["python3", ROOT / "build_tools" / "dev.py", "docs"], cwd=ROOT, check=True)
    return SITE


def test_every_document_has_a_page(site):
    for document in sorted((ROOT / "docs").glob("*.md")):
        assert (site / "docs" / f"{document.stem}.html").is_file(), document.name


def test_every_public_name_is_in_the_reference(site):
    import discrete_fairing

    page = (site / "api.html").read_text("utf-8")
    names = [name for name in discrete_fairing.__all__ if not name.startswith("_")]
    assert [name for name in names if f'id="discrete_fairing.{name}"' not in page] == []


def test_search_knows_a_word_of_the_documents(site):
    assert "curvatur" in (site / "searchindex.js").read_text("utf-8")


def test_no_page_loads_anything_over_the_network(site):
    loaded = re.compile(r"<(?:script|img|link|iframe)\b[^>]*?(?:src|href)=\"((?:https?:)?//[^\"]+)")
    found = {
        (page.name, address)
        for page in site.rglob("*.html")
        for address in loaded.findall(page.read_text("utf-8"))
    }
    assert found == set()


@pytest.mark.parametrize("width", [1400, 500])
@pytest.mark.parametrize("page", ["index", "docs/settings", "api"])
def test_browser_draws_the_page(site, page, width):
    SCREENSHOTS.mkdir(parents=True, exist_ok=True)
    picture = SCREENSHOTS / f"{Path(page).name}-{width}.png"
    picture.unlink(missing_ok=True)
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
    options += [f"--window-size={width},1000", f"--screenshot={picture}"]
    address = (site / f"{page}.html").as_uri()
    subprocess.run(["chromium", *options, address], check=True, timeout=120, capture_output=True)
    size = picture.read_bytes()[PNG_SIZE]
    assert (int.from_bytes(size[:4]), int.from_bytes(size[4:])) == (width, 1000)
