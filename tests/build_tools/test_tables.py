# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of the documents are those of benchmarks/results."""

import tables


def test_tables_are_those_of_the_results():
    """Where this fails, run build_tools/tables.py."""
    named = set()
    for path in tables.documents():
        text = path.read_text("utf-8")
        marks = tables.MARKED.findall(text)
        assert text.count("<!-- table:") == text.count("<!-- /table -->") == len(marks), path
        assert tables.filled(text) == text, path
        named |= {name for _, name, _ in marks}
    assert named == {path.stem for path in tables.TABLES.glob("*.md")}


def test_a_wrong_table_is_seen_and_mended():
    text = "<!-- table: drag -->\n\n| a |\n\n<!-- /table -->"
    assert "| a |" not in tables.filled(text) and "first moves" in tables.filled(text)
