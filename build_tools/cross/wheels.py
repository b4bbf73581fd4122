# SPDX-License-Identifier: GPL-3.0-or-later
"""Wheels for other platforms: the package's Python files, a cross-compiled module, the metadata that pip would write."""

import base64
import hashlib
import shutil
import tempfile
import zipfile
from email.parser import Parser
from pathlib import Path

from layout import CACHE, ROOT, VENV_PYTHON
from native_wheel import inputs, local_version
from shell import DevError, run, say
from stamp import alone, files_under, fingerprint, is_fresh, leave
from wheel_version import LOCAL_PART

from cross import native_build
from cross.inspection import faults
from cross.targets import PYTHONS, Target

PACKAGE = ROOT / "native" / "binding" / "discrete_fairing"
WHEELS = native_build.BUILD / "wheels" / "cross"
# as a build front end asks for it, without compiling
METADATA = (
    "import sys, scikit_build_core.build as b; b.prepare_metadata_for_build_wheel(sys.argv[1])"
)


def metadata(folder: Path) -> dict[str, bytes]:
    """The files of `dist-info` by their name in the wheel."""
    run(VENV_PYTHON, "-c", METADATA, folder, **{LOCAL_PART: local_version()})
    (info,) = folder.glob("*.dist-info")
    files = [path for path in info.rglob("*") if path.is_file() and path.name != "RECORD"]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def tagged(wheel_file: bytes, tag: str) -> bytes:
    """A wheel's file WHEEL with another tag."""
    lines = [line for line in wheel_file.decode().splitlines() if line.strip()]
    kept = [line for line in lines if not line.startswith(("Tag:", "Root-Is-Purelib:"))]
    return "\n".join([*kept, "Root-Is-Purelib: false", f"Tag: {tag}", ""]).encode()


def record(files: dict[str, bytes], name: str) -> bytes:
    """The list of all files with their hashes, which lists itself without one."""
    lines = []
    for path, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        lines.append(f"{path},sha256={digest},{len(data)}")
    return "\n".join([*lines, f"{name},,", ""]).encode()


def package() -> dict[str, bytes]:
    """The package's Python files by their name in the wheel."""
    return {
        path.relative_to(PACKAGE.parent).as_posix(): path.read_bytes()
        for path in files_under(PACKAGE)
    }


def pack(module: Path, info: dict[str, bytes], tag: str, folder: Path) -> Path:
    """Writes one wheel."""
    (wheel_name,) = (name for name in info if name.endswith(".dist-info/WHEEL"))
    top = wheel_name.partition("/")[0]
    version = Parser().parsestr(info[f"{top}/METADATA"].decode())["Version"]
    files = {**package(), f"discrete_fairing/{module.name}": module.read_bytes(), **info}
    files[wheel_name] = tagged(info[wheel_name], tag)
    files[f"{top}/RECORD"] = record(files, f"{top}/RECORD")
    path = folder / f"discrete_fairing-{version}-{tag}.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return path


def build(target: Target, pythons: tuple[str, ...] = PYTHONS) -> list[Path]:
    """One platform's wheels, compiled and inspected; returns at once when nothing changed."""
    with alone("cross"):
        folder, stamp = WHEELS / target.name, CACHE / f"cross-{target.name}.stamp"
        value = fingerprint(
            inputs() + files_under(ROOT / "build_tools" / "cross"), local_version(), *pythons
        )
        if not (is_fresh(stamp, value) and folder.is_dir()):
            say(f"cross compilation for {target.name}")
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            with tempfile.TemporaryDirectory() as made:
                info = metadata(Path(made))
            for python in pythons:
                tag = f"{python}-{python}-{target.wheel_tag}"
                wheel = pack(native_build.module(target, python), info, tag, folder)
                if found := faults(wheel):
                    raise DevError(f"{wheel.name}: {'; '.join(found)}.")
            leave(stamp, value)
        return sorted(folder.glob("*.whl"))
