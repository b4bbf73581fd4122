# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that cross-compiled wheels load on the oldest system of their tag without further libraries.

python -m cross.inspection WHEEL…, by .venv's Python, which has LIEF.
"""

import re
import sys
import tempfile
import zipfile
from dataclasses import dataclass, field
from pathlib import Path

import lief

LARGEST = 3_000_000  # bytes of a wheel

# parts of every such system; Windows has had its C library since version 10
WINDOWS = r"(?i)kernel32\.dll|ntdll\.dll|advapi32\.dll|api-ms-win-crt-[\w-]+\.dll|ucrtbase\.dll"
LINUX = r"lib(c|m|pthread|dl|rt)\.so\.\d+|ld-linux-(x86-64|aarch64)\.so\.\d+"
MACOS = r"/usr/lib/libSystem\.B\.dylib"


@dataclass
class Binary:
    """The properties of a module that decide where it can be loaded."""

    processor: str
    libraries: list[str] = field(default_factory=list)
    least_system: tuple[int, ...] = ()  # glibc's or macOS's version
    exports: list[str] | None = None  # None: not read, as on macOS
    signed: bool = False
    for_debuggers: bool = False  # has data for debuggers; read on Linux only


def glibc(module: lief.ELF.Binary) -> tuple[int, ...]:
    """The newest version of the C library that a module for Linux needs."""
    names = [
        v.name for file in module.symbols_version_requirement for v in file.get_auxiliary_symbols()
    ]
    found = [re.fullmatch(r"GLIBC_([\d.]+)", name) for name in names]
    return max((tuple(map(int, match[1].split("."))) for match in found if match), default=())


def read(path: Path) -> Binary:
    """A module of Windows, Linux or macOS."""
    module = lief.parse(path)
    if module is None:
        raise ValueError(f"{path.name} is no module of Windows, Linux or macOS.")
    found = Binary(module.abstract.header.architecture.name.lower(), module.abstract.libraries)
    if isinstance(module, lief.MachO.Binary):
        own = lief.MachO.LoadCommand.TYPE.ID_DYLIB  # its own name
        found.libraries = [each.name for each in module.libraries if each.command != own]
        found.least_system = tuple(module.build_version.minos[:2])
        found.signed = module.has_code_signature
        return found
    found.exports = [function.name for function in module.exported_functions]
    if isinstance(module, lief.ELF.Binary):
        found.exports = [symbol.name for symbol in module.exported_symbols]
        found.least_system = glibc(module)
        found.for_debuggers = module.has_section(".debug_info")
    return found


def allowed_libraries(tag: str, python: str) -> str:
    """A pattern of the libraries that a module may need."""
    if tag.startswith("win"):
        return f"{WINDOWS}|{python.replace('cp', 'python')}\\.dll"
    return LINUX if "linux" in tag else MACOS


def named_system(tag: str) -> tuple[int, ...]:
    """The oldest system of a tag; Windows' tags have none."""
    found = re.search(r"_(\d+)_(\d+)_", tag)
    return (int(found[1]), int(found[2])) if found else ()


def offered(tag: str) -> str:
    """A pattern of the names that a module may export.

    pybind11 exports its exceptions on Windows, where modules do not take each other's names by accident.
    """
    return r"PyInit__native|_Z.*8pybind11.*" if tag.startswith("win") else "PyInit__native"


def faults_of(module: Binary, tag: str, python: str) -> list[str]:
    """The faults of a module, given the tag of its wheel."""
    processor = "arm64" if tag.endswith(("aarch64", "arm64")) else "x86_64"
    allowed = allowed_libraries(tag, python)
    foreign = [name for name in module.libraries if not re.fullmatch(allowed, name)]
    others = [name for name in module.exports or [] if not re.fullmatch(offered(tag), name)]
    checks = {
        f"it is for {module.processor}": module.processor == processor,
        f"it needs {', '.join(foreign)}": not foreign,
        f"it needs the system {module.least_system}": module.least_system <= named_system(tag),
        f"it exports {', '.join(others[:5])}": not others,
        "it does not export PyInit__native": module.exports is None
        or "PyInit__native" in module.exports,
        "it has no signature, without which macOS on ARM loads nothing": module.signed
        or not (tag.startswith("macosx") and tag.endswith("arm64")),
        "it holds data for debuggers": not module.for_debuggers,
    }
    return [fault for fault, fine in checks.items() if not fine]


def faults(wheel: Path) -> list[str]:
    """The faults of a wheel."""
    python = wheel.stem.split("-")[2]
    with tempfile.TemporaryDirectory() as made, zipfile.ZipFile(wheel) as archive:
        modules = [name for name in archive.namelist() if name.endswith((".so", ".pyd", ".dylib"))]
        if len(modules) != 1:
            return [f"it should hold one module, but holds {len(modules)}"]
        module = read(Path(archive.extract(modules[0], made)))
        found = faults_of(module, wheel.stem.split("-")[-1], python)
    if wheel.stat().st_size > LARGEST:
        found.append(f"it has {wheel.stat().st_size} bytes, more than {LARGEST}")
    return found


if __name__ == "__main__":
    wrong = [
        f"{Path(name).name}: {'; '.join(found)}."
        for name in sys.argv[1:]
        if (found := faults(Path(name)))
    ]
    sys.exit("\n".join(wrong) or 0)  # an empty text would count as a failure
