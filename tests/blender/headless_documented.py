# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls that the documents show, as they stand there, in this Blender and its Python."""

import contextlib
import os
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import harness

DOCS = Path(__file__).resolve().parents[1] / "docs"  # copied beside the scripts


def test_the_page_on_scripts():
    blocks = re.findall(
        r"^```python\n(.*?)^```", (DOCS / "how-to" / "scripting.md").read_text("utf-8"), re.M | re.S
    )
    assert len(blocks) > 5
    namespace = {}
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        os.environ["PWD"] = folder
        for number, block in enumerate(blocks, 1):
            exec(compile(block, f"scripting.md, example {number}", "exec"), namespace)


harness.run(globals())
