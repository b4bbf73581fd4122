# SPDX-License-Identifier: GPL-3.0-or-later
"""The browser and the host are among the project's tools, which no other suite has on its path."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "build_tools"))
