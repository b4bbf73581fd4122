# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables on the terminal."""

from collections.abc import Sequence
from typing import Any


def cell(value: Any) -> str:
    """One value, four digits of a number at most."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"
    return str(value)


def show(title: str, heads: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
    """Prints a table: the first column to the left, numbers to the right."""
    lines = [list(heads), *[[cell(v) for v in row] for row in rows]]
    widths = [max(len(line[k]) for line in lines) for k in range(len(heads))]
    print(f"\n{title}\n")
    for line in lines:
        first, *others = (
            text.ljust(w) if not k else text.rjust(w)
            for k, (text, w) in enumerate(zip(line, widths))
        )
        print("  ".join([first, *others]))
        if line is lines[0]:
            print("  ".join("-" * w for w in widths))
    print(flush=True)
