# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a cross-compiled wheel can be loaded on the oldest system that its tag names, with nothing but itself."""

import re
import tempfile
import zipfile
from pathlib import Path

from layout import ROOT
from shell import DevError

from cross.binary import Binary, read

LARGEST = 3_000_000  # bytes of a wheel

# what every system of the kind has; Windows' C library is a part of the system since 10
WINDOWS = r"(?i)kernel32\.dll|ntdll\.dll|advapi32\.dll|api-ms-win-crt-[\w-]+\.dll|ucrtbase\.dll"
LINUX = r"lib(c|m|pthread|dl|rt)\.so\.\d+|ld-linux-(x86-64|aarch64)\.so\.\d+"
MACOS = r"/usr/lib/libSystem\.B\.dylib"


def platform_tag(wheel: Path) -> str:
    """The platform in a wheel's name."""
    return wheel.stem.split("-")[-1]


def processor(tag: str) -> str:
    """The processor that a tag is for, as `Binary` calls it."""
    return "arm64" if tag.endswith(("aarch64", "arm64")) else "x86_64"


def allowed_libraries(tag: str, python: str) -> str:
    """The pattern of the libraries that a module may need."""
    if tag.startswith("win"):
        return f"{WINDOWS}|{python.replace('cp', 'python')}\\.dll"
    return LINUX if "linux" in tag else MACOS


def named_system(tag: str) -> tuple[int, ...]:
    """The oldest system that a tag names; Windows' tag names none."""
    found = re.search(r"_(\d+)_(\d+)_", tag)
    return (int(found[1]), int(found[2])) if found else ()


def offered(tag: str) -> str:
    """The pattern of what a module may export.

    pybind11 asks for its exceptions on Windows, where no module takes another one's names by accident.
    """
    return r"PyInit__native|_Z.*8pybind11.*" if tag.startswith("win") else "PyInit__native"


def faults_of(module: Binary, tag: str, python: str) -> list[str]:
    """What is wrong with a module for the tag of its wheel."""
    allowed = allowed_libraries(tag, python)
    foreign = [name for name in module.libraries if not re.fullmatch(allowed, name)]
    others = [name for name in module.exports or [] if not re.fullmatch(offered(tag), name)]
    checks = {
        f"it is for {module.processor}": module.processor == processor(tag),
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


def names_this_folder(module: bytes) -> bool:
    """Whether the project's folder has got into a module, so that another one would make other bytes."""
    return bytes(ROOT) in module


def faults(wheel: Path) -> list[str]:
    """What is wrong with a wheel."""
    python = wheel.stem.split("-")[2]
    with tempfile.TemporaryDirectory() as made, zipfile.ZipFile(wheel) as archive:
        modules = [name for name in archive.namelist() if name.endswith((".so", ".pyd", ".dylib"))]
        if len(modules) != 1:
            raise DevError(f"{wheel.name} should hold one module, but holds {len(modules)}.")
        module = Path(archive.extract(modules[0], made))
        found = faults_of(read(module), platform_tag(wheel), python)
        if names_this_folder(module.read_bytes()):
            found.append(f"it names {ROOT}, where it was compiled")
    if wheel.stat().st_size > LARGEST:
        found.append(f"it has {wheel.stat().st_size} bytes, more than {LARGEST}")
    return found
