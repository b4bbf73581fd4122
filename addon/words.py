# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of things and lists, as sentences say them. No Blender."""

from collections.abc import Sequence


def counted(number: int, one: str, more: str = "") -> str:
    """`1 hole`, `3,000 holes`; `more`: what several are called, if not `one` with an s."""
    return f"1 {one}" if number == 1 else f"{number:,} {more or one + 's'}"


def listed(parts: Sequence[str], last: str = "and") -> str:
    """`a, b and c`."""
    return f" {last} ".join(filter(None, (", ".join(parts[:-1]), *parts[-1:])))
