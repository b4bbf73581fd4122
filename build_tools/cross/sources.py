# SPDX-License-Identifier: GPL-3.0-or-later
"""Sources for cross compilation, each at one version with its hash: zig by pip, others from Debian."""

import hashlib
import shutil
import tarfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from urllib.request import urlretrieve

from layout import CACHE, ROOT
from python_environment import install_tool
from shell import DevError, output, say
from stamp import alone, is_fresh, leave

FOLDER = CACHE / "cross"
ZIG = ROOT / "build_tools" / "requirements_zig.lock"


def debian(file: str, folder: Path) -> None:
    """Downloads a file from the pool of the mirror that apt uses."""
    _, text = output("apt-get", "indextargets", "--format", "$(REPO_URI)")
    mirrors = [mirror for mirror in text.split() if "security" not in mirror]
    if not mirrors:
        raise OSError("apt-get names no mirror: run `apt-get update`")
    urlretrieve(f"{mirrors[0].rstrip('/')}/pool/main/{file}", folder / Path(file).name)


@dataclass(frozen=True)
class Source:
    """An archive of Debian's pool."""

    name: str
    file: str
    sha256: str

    @property
    def archive(self) -> Path:
        return FOLDER / "archives" / Path(self.file).name

    def fetch(self) -> Path:
        """The archive, downloaded if missing; an archive with another hash is refused."""
        if not self.archive.is_file():
            say(f"fetching {self.archive.name}")
            self.archive.parent.mkdir(parents=True, exist_ok=True)
            try:
                debian(self.file, self.archive.parent)
            except OSError as error:
                raise DevError(
                    f"{self.archive.name} cannot be fetched ({error}): put the file into "
                    f"{self.archive.parent} by hand."
                ) from error
        self._check(self.archive)
        return self.archive

    def _check(self, path: Path) -> None:
        found = hashlib.sha256(path.read_bytes()).hexdigest()
        if found != self.sha256:
            path.unlink()
            raise DevError(
                f"{self.archive.name} has the hash {found}, not {self.sha256} as in cross/sources.py: it is "
                "not the file that we know, and was deleted."
            )

    def unpacked(self, wanted: Callable[[str], bool] = lambda name: True) -> Path:
        """The folder of the archive's files, only those with `wanted` names."""
        folder, stamp = FOLDER / self.name, FOLDER / f"{self.name}.stamp"
        with alone("cross-sources"):
            if not (is_fresh(stamp, self.sha256) and folder.is_dir()):
                archive = self.fetch()
                shutil.rmtree(folder, ignore_errors=True)
                with tarfile.open(archive) as file:
                    # their hashes are checked
                    file.extractall(folder, [m for m in file if wanted(m.name)])
                leave(stamp, self.sha256)
        return folder


def only_folder(folder: Path) -> Path:
    """The single folder in an archive of sources."""
    (found,) = (path for path in folder.iterdir() if path.is_dir())
    return found


OPENMESH = Source(
    "openmesh",
    "o/openmesh/openmesh_11.0.0.orig.tar.gz",
    "c7f35d29673e6dbb6d65b214c10c4c6249521a8f1e8f8db6e8bdc2eed798aedc",
)
PYTHON_SOURCES = {
    "cp311": Source(
        "python311",
        "p/python3.11/python3.11_3.11.2.orig.tar.gz",
        "2411c74bda5bbcfcddaf4531f66d1adc73f247f529aee981b029513aefdbf849",
    ),
    "cp313": Source(
        "python313",
        "p/python3.13/python3.13_3.13.5.orig.tar.xz",
        "93e583f243454e6e9e4588ca2c2662206ad961659863277afcdb96801647d640",
    ),
}


def zig() -> Path:
    """zig's program: clang, its linker, and the libraries of every platform."""
    with alone("zig"):
        python = install_tool("zig", ZIG)
    (program,) = python.parent.parent.glob("lib/python*/site-packages/ziglang/zig")
    for tool in ("ar", "ranlib"):  # CMake needs programs without arguments
        script = program.with_name(f"zig-{tool}")
        script.write_text(f'#!/bin/sh\nexec "{program}" {tool} "$@"\n')
        script.chmod(0o755)
    return program


def openmesh() -> Path:
    """OpenMesh's sources."""
    return only_folder(OPENMESH.unpacked(lambda name: "/src/OpenMesh/Core" in name)).resolve()
