# SPDX-License-Identifier: GPL-3.0-or-later
"""The site is built without a warning, works without a network, and is drawn by a real browser, wide and narrow."""

import re
import subprocess
from pathlib import Path

import pytest
from browser import html_of, photograph
from serving import served

ROOT = Path(__file__).resolve().parents[2]
SITE = ROOT / "out" / "site"
SCREENSHOTS = ROOT / "out" / "screenshots" / "site"
LARGEST = 8_000_000  # bytes of the page of turning surfaces


def png_size(path):
    """Width and height, from a PNG's first chunk."""
    size = path.read_bytes()[16:24]
    return int.from_bytes(size[:4]), int.from_bytes(size[4:])


@pytest.fixture(scope="module")
def site():
    """The folder that `dev.py docs` makes; a warning makes that fail."""
    subprocess.run(["python3", ROOT / "build_tools" / "dev.py", "docs"], cwd=ROOT, check=True)
    return SITE


def test_every_document_has_a_page(site):
    documents = ROOT / "docs"
    pages = [path for path in documents.rglob("*.md") if path.parent != documents / "site"]
    assert len(pages) > 40
    for page in pages:
        assert (site / page.relative_to(ROOT).with_suffix(".html")).is_file(), page


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


DARK = "--blink-settings=preferredColorScheme=0"
WIDE, NARROW = (1400, 1000), (500, 1000)


@pytest.fixture(scope="module")
def address(site):
    """Where a host on this machine serves the site."""
    with served(site) as found:
        yield found


@pytest.mark.parametrize("size", [WIDE, NARROW], ids=["wide", "narrow"])
@pytest.mark.parametrize("page", ["index", "docs/reference/settings", "api", "turning"])
def test_browser_draws_the_page(address, page, size):
    picture = SCREENSHOTS / f"{Path(page).name}-{size[0]}.png"
    photograph(f"{address}/{page}.html", picture, size)
    assert png_size(picture) == size


@pytest.mark.parametrize("page", ["index", "docs/explanation/pads", "turning"])
def test_browser_draws_the_page_in_the_dark(address, page):
    light, dark = (SCREENSHOTS / f"{Path(page).name}-{name}.png" for name in ("light", "dark"))
    photograph(f"{address}/{page}.html", light, WIDE)
    photograph(f"{address}/{page}.html", dark, WIDE, DARK)
    assert png_size(dark) == WIDE
    assert light.read_bytes() != dark.read_bytes()


RESULT = re.compile(r'<li[^>]*>\s*<a href="([^"#?]+)')


@pytest.mark.parametrize("from_disk", [False, True], ids=["served", "from a disk"])
def test_search_finds_pages(site, address, from_disk):
    """Without a network; from a disk too, where pages cannot read one another."""
    page = (site / "search.html").as_uri() if from_disk else f"{address}/search.html"
    html = html_of(f"{page}?q=reflections")
    found = RESULT.findall(html[html.index('id="search-results"') :])
    assert any(path.endswith("how-to/inspecting.html") for path in found), found


def figures(page):
    """The figures that turn, as (number of pictures, number of canvases) of each."""
    found = re.findall(r'<figure class="[^"]*\bturning\b.*?</figure>', page, re.DOTALL)
    return [(figure.count("<img"), figure.count("<canvas")) for figure in found]


def models(site):
    return sorted(path.stem for path in (site / "_static" / "models").glob("*.glb"))


def test_every_model_turns(site, address):
    page = html_of(f"{address}/turning.html")
    assert figures(page) == [(0, 1)] * len(models(site))
    assert page.count('data-turning="yes"') == len(models(site)) > 0
    for way in ("Subdivision Surface", "Thin plate", "Total curvature", "Control mesh"):
        assert page.count(f">{way}</button>") == len(models(site)), way


def test_without_scripts_there_are_pictures(site):
    page = (site / "turning.html").read_text("utf-8")
    assert figures(page) == [(1, 0)] * len(models(site))
    for name in models(site):
        assert f"/turning_{name}.png" in page, name


def test_from_a_disk_the_pictures_stay(site):
    page = html_of((site / "turning.html").as_uri())
    assert figures(page) == [(1, 0)] * len(models(site))


def test_what_turns_is_small_and_has_its_licence(site):
    static = site / "_static"
    parts = [path for name in ("models", "three") for path in (static / name).iterdir()]
    assert sum(path.stat().st_size for path in parts) < LARGEST
    assert "Expat" in (static / "three" / "copyright").read_text("utf-8")
