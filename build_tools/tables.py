# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of the documents, from benchmarks/results/tables, where each is a file.

    python3 build_tools/tables.py

A table stands in Markdown between two comments: <!-- table: NAME -->…<!-- /table -->. Sentences beside it may repeat its
numbers; nothing keeps those up to date.
"""

import re
from collections.abc import Iterator
from pathlib import Path

from layout import ROOT

TABLES = ROOT / "benchmarks" / "results" / "tables"
MARKED = re.compile(r"(<!-- table: ([\w.]+) -->).*?(<!-- /table -->)", re.DOTALL)


def documents() -> Iterator[Path]:
    """All Markdown files that may contain tables."""
    yield from sorted(ROOT.glob("*.md"))
    yield from sorted((ROOT / "docs").rglob("*.md"))


def filled(text: str) -> str:
    """`text` with each table from the results; FileNotFoundError for an unknown name."""

    def table(match: re.Match[str]) -> str:
        return f"{match[1]}\n\n{(TABLES / f'{match[2]}.md').read_text('utf-8')}\n{match[3]}"

    return MARKED.sub(table, text)


if __name__ == "__main__":
    for path in documents():
        path.write_text(filled(path.read_text("utf-8")), "utf-8")
