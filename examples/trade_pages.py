# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the scripts of docs/trades/ and docs/how-to/ for pictures and sample files of the same meshes."""

import re
from pathlib import Path

import bpy

DOCS = Path(__file__).resolve().parents[1] / "docs"


def scripted(page, scripts=1):
    """The active object after the first `scripts` scripts of a page, as "trades/hull"."""
    text = (DOCS / f"{page}.md").read_text("utf-8")
    found = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    names = {}
    for script in found[:scripts]:
        exec(compile(script, page, "exec"), names)
    return bpy.context.active_object
