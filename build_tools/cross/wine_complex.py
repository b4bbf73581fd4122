# SPDX-License-Identifier: GPL-3.0-or-later
"""NumPy 2 for Windows under Wine 10: the functions of complex numbers that its C library lacks.

A library of ours has them and passes the other functions on; NumPy's and SciPy's modules are told to
look there, by a name as long as the one in its place.
"""

import re
from pathlib import Path

from shell import run

from cross.sources import zig

SOURCE = Path(__file__).with_name("wine_complex.c")
THEIRS = "api-ms-win-crt-math-l1-1-0.dll"
OURS = "crt-math-with-complex-ones.dll"
SYSTEM = "ucrtbase"  # which has the others
KINDS = {"": "", "f": "f", "l": ""}  # long double is a double on Windows


def functions() -> dict[str, str]:
    """Our functions by the names that they are exported under."""
    own = re.findall(r"^\w+ df_(c\w+)\(number", SOURCE.read_text(), re.MULTILINE)
    return {name + kind: f"df_{name}{of}" for name in own for kind, of in KINDS.items()}


def names() -> set[str]:
    """What Windows' library of mathematics exports, by the list that comes with zig."""
    listed = zig().parent / "lib" / "libc" / "mingw" / "lib-common" / f"{Path(THEIRS).stem}.def.in"
    lines = [
        line.partition(";")[0] for line in listed.read_text().partition("EXPORTS")[2].splitlines()
    ]
    words = re.findall(r"\b[_a-z]\w*", " ".join(line for line in lines if not line.startswith("#")))
    return set(words)


def definition(exported: set[str]) -> str:
    """The module definition: our functions for these names, and the system's for the others."""
    sources = {name: f"{SYSTEM}.{name}" for name in exported} | functions()
    lines = [f"    {name}={source}" for name, source in sorted(sources.items())]
    return "\n".join([f"LIBRARY {OURS}", "EXPORTS", *lines, ""])


def redirect(module: Path) -> None:
    """Has a module look in our library."""
    data = module.read_bytes()
    module.write_bytes(data.replace(THEIRS.encode() + b"\0", OURS.encode() + b"\0"))


def install(packages: Path, folder: Path) -> None:
    """Puts the library into the Python's folder and has all modules of these packages look there."""
    exports = folder / "crt_math.def"
    exports.write_text(definition(names()))
    options = ["-target", "x86_64-windows-gnu", "-O2", "-g0", "-shared"]
    run(zig(), "cc", *options, SOURCE, exports, "-o", folder / OURS)
    for module in packages.rglob("*"):
        if module.suffix in (".pyd", ".dll"):
            redirect(module)
