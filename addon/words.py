# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts and lists in sentences. No Blender."""

import re
from collections.abc import Sequence


def counted(number: int, text: str) -> str:
    """`1 hole`, `3,000 holes` from `hole`; or `2 vertices have` from `{vertex has|vertices have}`."""
    text = text if "{" in text else f"{{{text}|{text}s}}"
    return f"{number:,} " + re.sub(r"{(.*?)\|(.*?)}", r"\1" if number == 1 else r"\2", text)


def listed(parts: Sequence[str], last: str = "and") -> str:
    """For example `a, b and c`."""
    return f" {last} ".join(filter(None, (", ".join(parts[:-1]), *parts[-1:])))
