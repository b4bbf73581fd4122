# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables in Markdown, for the documents and the terminal."""

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

OUT = Path(__file__).resolve().parent.parent / "out" / "bench"


def measured(name: str) -> Any:
    """The figures of another benchmark on this machine."""
    return json.loads((OUT / f"{name}.json").read_text("utf-8"))["result"]


def short(value: float, digits: int = 2) -> str:
    """A number with so many digits, never with an exponent from a thousandth to a million."""
    if value and not 1e-3 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}".replace("e-0", "e-")
    text = f"{value:.{digits}g}"
    return f"{float(text):,.0f}" if "e" in text or abs(value) >= 1000 else text


def markdown(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in lines of its own."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n\n" + "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n\n"
