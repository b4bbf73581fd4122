# SPDX-License-Identifier: GPL-3.0-or-later
"""Each picture of the documents has a date, a script and a page, and shows this version."""

import re

import pictures
from layout import ROOT
from wheel_version import manifest_version

PAGE = pictures.PAGE.read_text("utf-8")


def shown():
    """Names of the pictures that the documents show."""
    texts = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    found = [
        re.findall(r"!\[[^\]]*\]\(\S*?images/(\S+?)\)", path.read_text("utf-8")) for path in texts
    ]
    return {name for names in found for name in names}


def test_each_picture_is_dated_and_shown():
    made = pictures.rows(PAGE)
    assert sorted(made) == pictures.pictures()
    assert set(made) == shown()
    assert pictures.page(made) == PAGE


def test_each_picture_has_a_script_and_shows_this_version():
    for name, (by, version, _commit, _day) in pictures.rows(PAGE).items():
        assert by == pictures.maker(name)
        assert name in pictures.BY_HAND or (ROOT / by.split()[0]).is_file(), name
        assert version == manifest_version(), f"{name} is older: dev.py pictures"
