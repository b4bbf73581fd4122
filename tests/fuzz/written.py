# SPDX-License-Identifier: GPL-3.0-or-later
"""Any call of the writer of STEP files: a whole file of finite numbers, or a refusal that leaves nothing."""

import math
import os
import re
from pathlib import Path
from typing import Any

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
from hypothesis import strategies as st

CUBE = df.fit_patches(*meshes.cube(), levels=2, force=True, tolerance=0.1)
OPEN = df.fit_patches(*meshes.grid(1, 1), levels=2, force=True, tolerance=0.1)
REFUSALS = {"BAD_OPTION", "BAD_SHAPE"}

ODD = st.sampled_from((None, True, 3, -1.0, math.nan, math.inf, b"a", "", (), [[]], {}, object()))
TEXT = st.text(st.characters(), max_size=12) | st.sampled_from(
    ("a')", "a',#1", "';\n", "\\X2\\D83D\\X0\\", "\0", "\ud800", "ß🐟", "*/", "n" * 300)
)
UNIT = st.sampled_from(("m", "cm", "mm", "in", "ft", "M", "mile")) | ODD
SCALE = st.floats() | st.sampled_from((1e308, 5e-324, 1e-200, 10**400, "2", np.float32(2))) | ODD
SHARE = st.floats(0, 1) | st.floats()
COLOUR = st.tuples(SHARE, SHARE, SHARE) | st.lists(SHARE, max_size=4) | ODD | TEXT
MISSING = "none/a"  # in a folder that is not there
NAME = st.text(st.characters(codec="utf-8"), min_size=1, max_size=80)
PATH = NAME | st.sampled_from(("folder", "circle", "full", "link", MISSING, "n" * 400)) | TEXT | ODD
MATRIX = st.lists(st.floats(), min_size=16, max_size=16).map(lambda v: np.reshape(v, (4, 4)))


@st.composite
def calls(draw: st.DrawFn) -> dict[str, Any]:
    """Arguments of write_step, mostly ones that go together."""
    parts = draw(st.lists(st.sampled_from((CUBE, OPEN)), min_size=1, max_size=3))
    count = st.just(len(parts)) | st.integers(0, 3)
    options: dict[str, Any] = {}
    chosen = draw(st.sets(st.sampled_from(("unit", "scale", "names", "colours")), max_size=3))
    for name, values in (("unit", UNIT), ("scale", SCALE)):
        if name in chosen:
            options[name] = draw(values)
    for name, values in (("names", TEXT | ODD), ("colours", COLOUR)):
        if name in chosen:
            many = draw(count)
            options[name] = draw(st.lists(values, min_size=many, max_size=many) | values)
    return {
        "patches": draw(st.just(parts) | st.sampled_from((CUBE, None, [], [3], "cube"))),
        "options": options,
        "path": draw(st.just("a.step") | PATH),
    }


def place(folder: Path, path: object) -> object:
    """A name in the folder, and never out of it, where that is one."""
    if isinstance(path, bytes) and path:
        return os.fsencode(folder / "bytes")
    if isinstance(path, str) and path and "\0" not in path:
        return folder / (path if path == MISSING else path.replace("/", "|"))
    return path


def prepare(folder: Path) -> None:
    """Names that lead somewhere else."""
    (folder / "folder").mkdir()
    (folder / "circle").symlink_to("circle")
    (folder / "full").symlink_to("/dev/full")
    (folder / "link").symlink_to("behind")


def check(folder: Path, call: dict[str, Any]) -> str:
    """Returns how it went."""
    prepare(folder)
    before = sorted(folder.rglob("*"))
    try:
        path = place(folder, call["path"])
        df.write_step(path, call["patches"], **call["options"])
    except df.FairingError as error:
        assert error.code in REFUSALS and len(str(error)) > 15, error
        assert sorted(folder.rglob("*")) == before
        return error.code
    except OSError as error:
        assert error.strerror and error.filename == os.fsdecode(path), error
        assert sorted(folder.rglob("*")) == before
        return "OSError"
    check_step(Path(os.fsdecode(path)).read_bytes().decode("ascii"))
    assert not list(folder.glob(".*.part"))
    return "file"


def check_step(text: str) -> None:
    """Strings close where they should, numbers are numbers, every entity is there."""
    assert text.endswith("ENDSEC;\nEND-ISO-10303-21;\n")
    data = re.sub(r"'[^']*'", "''", text)
    assert not re.search(r"\b(nan|inf)\b", data, re.IGNORECASE)
    lines = data.split("DATA;\n")[1].split("ENDSEC;")[0].splitlines()
    assert all(re.fullmatch(r"#\d+=.*\);", line) for line in lines)
    assert all(line.count("(") == line.count(")") and "'''" not in line for line in lines)
    named = {int(n) for line in lines for n in re.findall(r"#(\d+)", line)}
    assert named == set(range(1, len(lines) + 1))


def check_moved(matrix: np.ndarray) -> None:
    """Finite patches, or a refusal: of the matrix, or by write_step of what it makes of them."""
    try:
        with np.errstate(all="ignore"):
            moved = CUBE.transformed(matrix)
    except df.FairingError as error:
        assert error.code == "BAD_SHAPE" and not np.isfinite(matrix).all()
        return
    assert np.isfinite(matrix).all() and len(moved) == len(CUBE)
