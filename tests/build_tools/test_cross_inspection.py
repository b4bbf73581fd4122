# SPDX-License-Identifier: GPL-3.0-or-later
"""The inspection of cross-compiled modules: its reading, its objections, and the wheels that were built."""

import struct
import zipfile
from importlib import metadata

import lief
import pytest
from cross import python_parts, wheels
from cross.inspection import Binary, faults, faults_of, read
from shell import DevError

INIT = ["PyInit__native"]
WINDOWS = Binary("x86_64", ["KERNEL32.dll", "python311.dll", "api-ms-win-crt-math-l1-1-0.dll"])
WINDOWS.exports = INIT
LINUX = Binary("arm64", ["libc.so.6", "ld-linux-aarch64.so.1"], (2, 28), INIT)
MACOS = Binary("arm64", ["/usr/lib/libSystem.B.dylib"], (11, 0), signed=True)
GOOD = {"win_amd64": WINDOWS, "manylinux_2_28_aarch64": LINUX, "macosx_11_0_arm64": MACOS}
BUILT = sorted(wheels.WHEELS.glob("*/*.whl"))


@pytest.mark.parametrize("tag", GOOD)
def test_a_good_module_has_no_faults(tag):
    assert faults_of(GOOD[tag], tag, "cp311") == []


@pytest.mark.parametrize(
    ("tag", "change", "fault"),
    [
        ("win_amd64", {"libraries": ["libstdc++-6.dll"]}, "needs libstdc"),
        ("win_amd64", {"libraries": ["python313.dll"]}, "needs python313"),
        ("win_amd64", {"exports": [*INIT, "_ZSt4cout"]}, "exports _ZSt4cout"),
        ("win_amd64", {"exports": []}, "does not export"),
        ("win_amd64", {"processor": "arm64"}, "is for arm64"),
        ("manylinux_2_28_aarch64", {"least_system": (2, 34)}, "needs the system"),
        ("manylinux_2_28_aarch64", {"libraries": ["libOpenMeshCore.so.9"]}, "needs libOpenMesh"),
        ("manylinux_2_28_aarch64", {"for_debuggers": True}, "for debuggers"),
        ("macosx_11_0_arm64", {"libraries": ["/usr/lib/libc++.1.dylib"]}, "needs /usr"),
        ("macosx_11_0_arm64", {"least_system": (12, 3)}, "needs the system"),
        ("macosx_11_0_arm64", {"signed": False}, "no signature"),
    ],
)
def test_faults_are_found(tag, change, fault):
    module = Binary(**{**vars(GOOD[tag]), **change})
    assert [found for found in faults_of(module, tag, "cp311") if fault in found]


def macho(*commands):
    """A file for macOS on ARM of load commands alone."""
    body = b"".join(commands)
    return struct.pack("<8I", 0xFEEDFACF, 0x0100000C, 0, 6, len(commands), len(body), 0, 0) + body


def dylib(command, name):
    padded = name.ljust(32, b"\0")
    return struct.pack("<6I", command, 24 + len(padded), 24, 0, 0, 0) + padded


def test_a_module_for_macos_is_read(tmp_path):
    """It is a shared library; its own name is no library that it needs."""
    path = tmp_path / "module.so"
    build_version = struct.pack("<6I", 0x32, 24, 1, 11 << 16, 12 << 16, 0)
    names = dylib(0xD, b"_native.so"), dylib(0xC, b"/usr/lib/libSystem.B.dylib")
    path.write_bytes(macho(build_version, *names, struct.pack("<4I", 0x1D, 16, 0, 0)))
    assert read(path) == MACOS


def installed_module():
    wheel = metadata.distribution("discrete-fairing")
    (module,) = (path for path in wheel.files if path.match("_native.*.so"))
    return module.locate()


def test_a_module_for_linux_is_read():
    found = read(installed_module())
    assert "libc.so.6" in found.libraries
    assert found.least_system >= (2, 14)
    assert "PyInit__native" in found.exports


def test_another_file_is_refused(tmp_path):
    (tmp_path / "text").write_text("no module")
    with pytest.raises(ValueError, match="no module"):
        read(tmp_path / "text")


def test_a_wheel_that_cannot_be_loaded_is_refused(tmp_path):
    """The inspection of cross-compiled wheels refuses it."""
    wheel = tmp_path / "ours-1-cp311-cp311-manylinux_2_17_x86_64.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.write(installed_module(), "discrete_fairing/_native.so")
    with pytest.raises(DevError, match=r"it needs .*libOpenMesh"):
        wheels.inspect([wheel])


def test_wheels_without_faults_pass():
    """Python ends with 1 for any text, even an empty one, so no release could be made."""
    wheels.inspect([])


@pytest.mark.skipif(not BUILT, reason="no wheel was cross-compiled: `dev.py extension --all`")
@pytest.mark.parametrize("wheel", BUILT, ids=lambda wheel: wheel.stem)
def test_the_wheels_that_were_built(wheel):
    assert faults(wheel) == []


def test_the_import_library_has_what_the_binding_uses():
    module = lief.parse(installed_module())
    names = {symbol.name for symbol in module.dynamic_symbols if symbol.shndx == 0}
    used = {name for name in names if name.lstrip("_").startswith("Py")}
    assert len(used) > 100
    assert used - set(python_parts.definition("cp311").split()[3:]) == set()
