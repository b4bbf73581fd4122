# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts and lists in sentences. No Blender."""

from collections.abc import Sequence


def counted(number: int, one: str, more: str = "") -> str:
    """For example `1 hole`, `3,000 holes`; `more`: the plural, if not `one` with an s."""
    return f"1 {one}" if number == 1 else f"{number:,} {more or one + 's'}"


def listed(parts: Sequence[str], last: str = "and") -> str:
    """For example `a, b and c`."""
    return f" {last} ".join(filter(None, (", ".join(parts[:-1]), *parts[-1:])))
