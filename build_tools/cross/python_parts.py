# SPDX-License-Identifier: GPL-3.0-or-later
"""Headers and, for Windows, import libraries of Pythons that are not on this machine."""

import re
import shutil
from pathlib import Path

from shell import run

from cross.sources import FOLDER, PYTHON_SOURCES, only_folder, zig
from cross.targets import Target

HERE = Path(__file__).resolve().parent
# the functions and objects of Python that pybind11 uses; a missing name is a linker error
NAMES = HERE / "python_names.txt"


def is_header(name: str) -> bool:
    """Whether a file of Python's sources is needed."""
    return re.search(r"^[^/]+/(Include/.*\.h|PC/pyconfig\.h(\.in)?)$", name) is not None


def headers(target: Target, python: str) -> Path:
    """The folder of a Python's headers for a platform."""
    source = only_folder(PYTHON_SOURCES[python].unpacked(is_header))
    folder = FOLDER / "headers" / f"{python}-{'windows' if target.is_windows else 'lp64'}"
    shutil.copytree(source / "Include", folder, dirs_exist_ok=True)
    config = HERE / "pyconfig.h"
    if target.is_windows:
        (config,) = (source / "PC").glob("pyconfig.h*")
    shutil.copy2(
        config, folder / "pyconfig.h"
    )  # with its time, or everything would be compiled again
    return folder


def definition(python: str) -> str:
    """The module definition with the used exports of a Python's library."""
    lines = [line.split() for line in NAMES.read_text().splitlines() if not line.startswith("#")]
    names = [name for name, *only in lines if python in (only or [python])]
    library = python.replace("cp", "python")
    return f"LIBRARY {library}.dll\nEXPORTS\n" + "".join(f"    {name}\n" for name in names)


def import_library(python: str) -> Path:
    """The import library by which a module for Windows finds Python when it is loaded."""
    folder = FOLDER / "headers"
    folder.mkdir(parents=True, exist_ok=True)
    library = folder / f"{python.replace('cp', 'python')}.lib"
    exports = library.with_suffix(".def")
    exports.write_text(definition(python))
    run(zig(), "dlltool", "-m", "i386:x86-64", "-d", exports, "-l", library)
    return library
