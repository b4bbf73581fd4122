# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of the documents, written from benchmarks/results.

    python3 build_tools/figures.py           writes them
    python3 build_tools/figures.py --check   names those that differ, and fails

A whole table stands in Markdown between two comments: <!-- figure: NAME -->…<!-- /figure -->. Sentences beside it may
repeat its numbers; nothing keeps those up to date.
"""

import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

from cost_figures import COST
from fill_figures import FILL
from layout import ROOT
from shape_figures import SHAPE

FIGURES: dict[str, Callable[[], str]] = {**COST, **FILL, **SHAPE}
FIGURE = re.compile(
    r"(<!-- figure: (?P<name>[\w.]+) -->)(?P<text>.*?)(<!-- /figure -->)", re.DOTALL
)


def documents() -> Iterator[Path]:
    """All Markdown that figures may stand in."""
    yield from sorted(ROOT.glob("*.md"))
    yield from sorted((ROOT / "docs").rglob("*.md"))


def filled(text: str) -> str:
    """`text` with each figure as the results have it; KeyError for a name that none has."""
    return FIGURE.sub(lambda m: m[1] + FIGURES[m["name"]]() + m[4], text)


def stale(text: str) -> list[str]:
    """The names of the figures in `text` that are not what the results say."""
    return [m["name"] for m in FIGURE.finditer(text) if m["text"] != FIGURES[m["name"]]()]


def main() -> int:
    """Writes the figures, or checks them."""
    check = "--check" in sys.argv[1:]
    wrong = 0
    for path in documents():
        text = path.read_text("utf-8")
        for name in stale(text):
            print(f"{path.relative_to(ROOT)}: {name}")
            wrong += 1
        if not check:
            path.write_text(filled(text), "utf-8")
    return 1 if check and wrong else 0


if __name__ == "__main__":
    sys.exit(main())
