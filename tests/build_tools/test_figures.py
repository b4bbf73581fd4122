# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of the documents are those of benchmarks/results, wherever they stand."""

import figures
import pytest
from results import short, span


@pytest.mark.parametrize("path", list(figures.documents()), ids=lambda path: path.name)
def test_figures_are_those_of_the_results(path):
    """Where this fails, run build_tools/figures.py."""
    assert figures.stale(path.read_text("utf-8")) == []


def test_every_figure_is_used():
    named = {
        match["name"]
        for path in figures.documents()
        for match in figures.FIGURE.finditer(path.read_text("utf-8"))
    }
    assert sorted(figures.FIGURES.keys() - named) == []


def test_every_mark_is_closed():
    for path in figures.documents():
        text = path.read_text("utf-8")
        marks = text.count("<!-- figure:"), text.count("<!-- /figure -->")
        assert marks == (len(figures.FIGURE.findall(text)),) * 2, path.name


def test_no_line_begins_with_a_number():
    """A comment at the start of a line is HTML to its end: links in that line would be dead."""
    for path in figures.documents():
        text = path.read_text("utf-8")
        numbers = [m for m in figures.FIGURE.finditer(text) if not m["text"].startswith("\n")]
        assert [m["name"] for m in numbers if text[: m.start()].endswith("\n")] == [], path.name


def test_a_wrong_figure_is_seen_and_mended():
    text = "It takes <!-- figure: peers.libigl -->40<!-- /figure --> times as long."
    assert figures.stale(text) == ["peers.libigl"]
    assert figures.stale(figures.filled(text)) == []
    assert figures.filled(text).endswith("<!-- /figure --> times as long.")


def test_a_figure_that_nobody_works_out_is_refused():
    with pytest.raises(KeyError):
        figures.filled("<!-- figure: nowhere -->1<!-- /figure -->")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0306, "0.031"),
        (1.41, "1.4"),
        (28.3, "28"),
        (1.78e-7, "1.8e-7"),
        (1260.0, "1,300"),
        (104, "100"),
    ],
)
def test_numbers_are_short(value, text):
    assert short(value) == text


def test_a_span_goes_from_the_least_to_the_largest():
    assert span([2.82, 1.41, 2.0]) == "1.4 to 2.8"
