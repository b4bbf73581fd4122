# SPDX-License-Identifier: GPL-3.0-or-later
"""The core's rooms stand in one order; import-linter does the same for Python (pyproject.toml)."""

import re
from pathlib import Path

NATIVE = Path(__file__).resolve().parents[2] / "native"

# From the ground up. Rooms on one line do not know each other.
ROOMS = (
    ("base",),
    ("parallel",),
    ("mesh",),
    ("grid",),
    ("stencil", "splines"),
    ("curves",),
    ("sparse",),
    ("transfer",),
    ("multigrid",),
    ("constraints",),
    ("thin_plate", "curvature"),
    ("paper",),
    ("fairing",),
    ("fit", "strain"),
    ("binding",),
)
FLOOR = {room: floor for floor, rooms in enumerate(ROOMS) for room in rooms}
INCLUDE = re.compile(r'^\s*#\s*include\s*"(([^"/]+)/[^"]+)"', re.MULTILINE)


def test_rooms_include_only_rooms_before_them():
    sources = [path for path in NATIVE.glob("*/**/*") if path.suffix in {".h", ".cpp"}]
    assert {path.relative_to(NATIVE).parts[0] for path in sources} == set(FLOOR)
    wrong = []
    for path in sources:
        room = path.relative_to(NATIVE).parts[0]
        for name, other in INCLUDE.findall(path.read_text("utf-8")):
            if other != room and not FLOOR[other] < FLOOR[room]:
                wrong.append(f"native/{path.relative_to(NATIVE)} includes {name}")
    assert wrong == []


def test_strain_knows_no_solver():
    """It stands on fairing, which solves for it."""
    solvers = {"thin_plate", "curvature", "multigrid", "sparse", "transfer", "paper"}
    for path in (NATIVE / "strain").iterdir():
        assert not solvers & {room for _, room in INCLUDE.findall(path.read_text("utf-8"))}, path
