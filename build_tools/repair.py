# SPDX-License-Identifier: GPL-3.0-or-later
"""Wheels that need nothing but the platform: the libraries that a user's machine lacks are put into them."""

import shutil
import tempfile
from pathlib import Path

from layout import VENV_BIN
from shell import DevError, output


def only_wheel(folder: Path) -> Path:
    """The one wheel in a folder."""
    found = list(folder.glob("*.whl"))
    if len(found) != 1:
        raise DevError(f"{folder} should hold one wheel, but holds {len(found)}.")
    return found[0]


def repair(wheel: Path, folder: Path, *libraries: Path) -> None:
    """Writes the self-contained wheel, named after the platforms that can load it, to `folder`.

    `libraries` are the folders to take libraries from; without any, it is the machine's own.
    """
    words = [VENV_BIN / "auditwheel", "repair", "--strip"]
    if libraries:
        words += ["--ldpaths", ":".join(map(str, libraries))]
    with tempfile.TemporaryDirectory() as made:
        code, text = output(*words, "--wheel-dir", made, wheel)
        if code != 0:
            raise DevError(f"{wheel.name} cannot be made self-contained: {text.strip()[-1000:]}")
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copy(only_wheel(Path(made)), folder)
