# SPDX-License-Identifier: GPL-3.0-or-later
"""What a compiled module needs and offers, read from the file itself: Windows', Linux' and macOS' formats."""

import re
import struct
from dataclasses import dataclass, field
from pathlib import Path

from shell import DevError, output

# load commands of Mach-O
LOAD_DYLIB, LOAD_WEAK_DYLIB, REEXPORT_DYLIB = 0xC, 0x80000018, 0x8000001F
CODE_SIGNATURE, VERSION_MIN, BUILD_VERSION = 0x1D, 0x24, 0x32
PROCESSORS = {0x01000007: "x86_64", 0x0100000C: "arm64"}


@dataclass
class Binary:
    """A module's needs, as far as they decide where it can be loaded."""

    processor: str
    libraries: list[str] = field(default_factory=list)
    least_system: tuple[int, ...] = ()  # glibc's or macOS's version
    exports: list[str] | None = None  # None: not read
    signed: bool = False
    for_debuggers: bool = (
        False  # has data for them; not read on Windows, where they are a file apart
    )


def read(path: Path) -> Binary:
    """Reads a module by its first bytes."""
    start = path.read_bytes()[:4]
    if start == b"\x7fELF":
        return read_elf(path)
    if start[:2] == b"MZ":
        return read_pe(path)
    if start == b"\xcf\xfa\xed\xfe":
        return read_macho(path.read_bytes())
    raise DevError(f"{path.name} is no module of Windows, Linux or macOS.")


def listing(*command: str | Path) -> str:
    """What a program of binutils says."""
    code, text = output(*command)
    if code:
        raise DevError(f"`{command[0]}` failed: {text.strip()[-500:]}")
    return text


def read_elf(path: Path) -> Binary:
    """A module for Linux, as readelf sees it."""
    parts = ["--file-header", "--section-headers", "--dynamic", "--version-info"]
    text = listing("readelf", "--wide", *parts, path)
    machine = "arm64" if "AArch64" in text else "x86_64" if "X86-64" in text else "unknown"
    versions = [
        tuple(map(int, found.split(".")))
        for found in re.findall(r"Name: GLIBC_(\d+(?:\.\d+)+)", text)
    ]
    symbols = listing("readelf", "--wide", "--dyn-syms", path)
    exports = re.findall(
        r"(?:GLOBAL|WEAK)\s+DEFAULT\s+(?!UND|ABS)\S+\s+([^\s@]+)", symbols, re.MULTILINE
    )
    return Binary(
        machine,
        re.findall(r"\(NEEDED\).*\[(.+?)\]", text),
        max(versions, default=()),
        exports,
        for_debuggers=".debug_info" in text,
    )


def read_pe(path: Path) -> Binary:
    """A module for Windows, as objdump sees it."""
    text = listing("objdump", "-p", path)
    machine = "x86_64" if "pei-x86-64" in text else "unknown"
    table = text.partition("[Ordinal/Name Pointer] Table")[2].partition("\n\n")[0]
    exports = re.findall(r"^\s*\[\s*\d+\].*?(\S+)$", table, re.MULTILINE)
    return Binary(machine, re.findall(r"DLL Name: (\S+)", text), exports=exports)


def unpacked_version(packed: int) -> tuple[int, int]:
    """A version of macOS."""
    return packed >> 16, packed >> 8 & 0xFF


def read_macho(data: bytes) -> Binary:
    """A module for macOS, by its load commands."""
    kind, commands = struct.unpack_from("<4xi8xI", data)
    found = Binary(PROCESSORS.get(kind, "unknown"))
    at = 32
    for _ in range(commands):
        command, size = struct.unpack_from("<II", data, at)
        if command in (LOAD_DYLIB, LOAD_WEAK_DYLIB, REEXPORT_DYLIB):
            (name,) = struct.unpack_from("<I", data, at + 8)
            found.libraries.append(data[at + name : at + size].partition(b"\0")[0].decode())
        elif command == BUILD_VERSION:
            found.least_system = unpacked_version(struct.unpack_from("<I", data, at + 12)[0])
        elif command == VERSION_MIN:
            found.least_system = unpacked_version(struct.unpack_from("<I", data, at + 8)[0])
        elif command == CODE_SIGNATURE:
            found.signed = True
        at += size
    return found
