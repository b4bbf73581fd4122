# SPDX-License-Identifier: GPL-3.0-or-later
"""The wheel of the package discrete_fairing: compiled core, binding and Python files."""

import shutil
from pathlib import Path

from layout import BUILD, MANIFEST, ROOT, VENV, VENV_BIN
from python_environment import pip
from shell import DevError, output, say
from stamp import alone, files_under, fingerprint, is_fresh, leave
from wheel_version import LOCAL_PART, manifest_version

WHEELS = BUILD / "wheels"
STAMP = VENV / "stamps" / "wheel"
RELEASE = (
    BUILD / "release"
)  # the folder of the preset for tests, so that the core is compiled once for both
# -Werror only here; other compilers may have new warnings
PIP_WHEEL = ["wheel", "--no-deps", "--no-build-isolation"]
PIP_WHEEL += ["--config-settings=cmake.define.DF_WARNINGS_AS_ERRORS=ON"]


def inputs() -> list[Path]:
    """Every file that the wheel depends on."""
    names = ["native", "cmake", "CMakeLists.txt", "pyproject.toml", "LICENSE"]
    names += ["THIRD_PARTY_LICENSES.txt", "build_tools/wheel_version.py"]
    return files_under(MANIFEST, *(ROOT / name for name in names))


def local_version() -> str:
    """The local part of a development build's version, from its content; empty for a tagged release."""
    _, tags = output("git", "tag", "--points-at", "HEAD")
    clean = output("git", "status", "--porcelain", "--untracked-files=no") == (0, "")
    if clean and f"v{manifest_version()}" in tags.split():
        return ""
    return f"g{fingerprint(inputs())[:10]}"


def only_wheel(folder: Path) -> Path:
    """The one wheel in a folder."""
    found = list(folder.glob("*.whl"))
    if len(found) != 1:
        raise DevError(f"{folder} should hold one wheel, but holds {len(found)}.")
    return found[0]


def repair(wheel: Path, folder: Path, *libraries: Path) -> None:
    """Writes the self-contained wheel, named after the platforms that can load it, to `folder`.

    `libraries`: folders to copy libraries from; without any, the machine's own.
    """
    words = [VENV_BIN / "auditwheel", "repair", "--strip"]
    if libraries:
        words += ["--ldpaths", ":".join(map(str, libraries))]
    code, text = output(*words, "--wheel-dir", folder, wheel)
    if code != 0:
        raise DevError(f"{wheel.name} cannot be made self-contained: {text.strip()[-1000:]}")


def build() -> Path:
    """Builds the wheel for the Python of .venv, incrementally."""
    raw, folder = WHEELS / "unrepaired", WHEELS / "venv"
    shutil.rmtree(raw, ignore_errors=True)
    shutil.rmtree(folder, ignore_errors=True)
    shared = [
        f"--config-settings=build-dir={RELEASE}",
        "--config-settings=cmake.define.DF_BUILD_TESTS=ON",
        "--config-settings=build.targets=_native",
    ]
    pip(*PIP_WHEEL, *shared, "--wheel-dir", raw, ROOT, **{LOCAL_PART: local_version()})
    repair(only_wheel(raw), folder)
    return only_wheel(folder)


def install() -> Path:
    """Builds the wheel and installs it into .venv; returns at once if nothing has changed."""
    with alone("wheel"):
        value = fingerprint(inputs(), local_version())
        if is_fresh(STAMP, value):
            return only_wheel(WHEELS / "venv")
        say("native build: the wheel of discrete_fairing")
        wheel = build()
        pip("install", "--no-deps", "--force-reinstall", wheel)
        leave(STAMP, value)
        return wheel
