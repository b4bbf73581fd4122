# SPDX-License-Identifier: GPL-3.0-or-later
"""The tools under test are a folder of plain modules, which no other suite has on its path."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "build_tools"))
