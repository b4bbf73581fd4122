# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of the documents are those of benchmarks/results, wherever they stand."""

import figures
import pytest
from results import short

TEXTS = {str(path): path.read_text("utf-8") for path in figures.documents()}


def test_tables_are_those_of_the_results():
    """Where this fails, run build_tools/figures.py."""
    stale = {name: figures.stale(text) for name, text in TEXTS.items()}
    assert {name: tables for name, tables in stale.items() if tables} == {}


def test_every_table_is_used_and_every_mark_closed():
    named = {match["name"] for text in TEXTS.values() for match in figures.FIGURE.finditer(text)}
    assert figures.FIGURES.keys() == named
    for name, text in TEXTS.items():
        marks = text.count("<!-- figure:"), text.count("<!-- /figure -->")
        assert marks == (len(figures.FIGURE.findall(text)),) * 2, name


def test_a_wrong_table_is_seen_and_mended():
    text = "<!-- figure: drag.table -->\n\n| a |\n\n<!-- /figure -->"
    assert figures.stale(text) == ["drag.table"]
    assert figures.stale(figures.filled(text)) == []


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0306, "0.031"), (28.3, "28"), (1.78e-7, "1.8e-7"), (1260.0, "1,300"), (104, "100")],
)
def test_numbers_are_short(value, text):
    assert short(value) == text
