# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs for Windows, run by Wine in a Debian system of its own: the native tests, and a real Windows Python."""

import shutil
import tarfile
import zipfile
from pathlib import Path, PureWindowsPath

from debian_root import INSIDE, DebianRoot
from layout import ROOT, VENV_PYTHON
from shell import run, say
from stamp import fingerprint, is_fresh, leave

from cross import wine_complex
from cross.sources import FOLDER, WINDOWS_PYTHONS

WINE = DebianRoot("trixie", "", purpose="wine", base_packages=("wine", "wine64"))
# what the tests import
REQUIREMENTS = {
    python: ROOT / "build_tools" / "cross" / f"windows_{python}.txt" for python in WINDOWS_PYTHONS
}


def windows_path(inside: Path) -> str:
    """A path of the Debian system as Wine's programs see it."""
    return str(PureWindowsPath("Z:\\", *inside.parts[1:]))


def command(*words: str | Path, **extra: str) -> list[str]:
    """The command line that runs a program for Windows; its paths are those of Windows."""
    quiet = {"WINEDEBUG": "-all", "XDG_RUNTIME_DIR": "/tmp", "DISPLAY": ""}
    return WINE.command("wine", *words, **{**quiet, **extra})


def unpack_python(python: str, folder: Path) -> None:
    """Lays out Windows' own Python with a folder for packages."""
    archive = WINDOWS_PYTHONS[python].fetch()
    with tarfile.open(archive) as package:
        (data,) = (member for member in package if member.name.endswith("/data.zip"))
        held = FOLDER / f"{python}-windows.zip"
        held.write_bytes(package.extractfile(data).read())
    with zipfile.ZipFile(held) as files:
        files.extractall(folder.parent)  # in a folder that is called as the Python's tag
    (paths,) = folder.glob("python3*._pth")
    # it looks nowhere else, not even beside a script
    found = ["Lib\\site-packages", windows_path(Path("/project/tests/python")), "import site"]
    paths.write_text("\n".join([paths.read_text(), *found, ""]))


def install_packages(python: str, folder: Path) -> None:
    """The test's packages, from PyPI's wheels for Windows."""
    version = f"{python[2]}.{python[3:]}"
    words = ["--platform", "win_amd64", "--python-version", version, "--only-binary", ":all:"]
    words += ["--require-hashes", "--no-deps", "--requirement", REQUIREMENTS[python]]
    words.append("--ignore-requires-python")  # which pip asks of its own Python
    target = folder / "Lib" / "site-packages"
    run(VENV_PYTHON, "-m", "pip", "--quiet", "install", *words, "--target", target)
    wine_complex.install(target, folder)


def python_folder(python: str) -> Path:
    """A Python for Windows with the tests' packages, as we see it; made once."""
    WINE.make()
    folder, stamp = WINE.outside / python, WINE.outside / f"{python}.stamp"
    parts = [REQUIREMENTS[python], wine_complex.SOURCE, Path(wine_complex.__file__)]
    value = fingerprint(parts, WINDOWS_PYTHONS[python].sha256)
    if not (is_fresh(stamp, value) and folder.is_dir()):
        say(f"Python for Windows, {python}, in {folder.relative_to(ROOT)}")
        shutil.rmtree(folder, ignore_errors=True)
        unpack_python(python, folder)
        install_packages(python, folder)
        leave(stamp, value)
    return folder


def install_wheel(wheel: Path, folder: Path) -> None:
    """Puts our wheel beside the packages, in place of an older one."""
    target = folder / "Lib" / "site-packages"
    for old in target.glob("discrete_fairing*"):
        shutil.rmtree(old)
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(target)


def python_command(python: str, *words: str, **extra: str) -> list[str]:
    """The command line of a Windows Python."""
    program = windows_path(INSIDE / python / "python.exe")
    return command(program, *words, PYTHONDONTWRITEBYTECODE="1", **extra)
