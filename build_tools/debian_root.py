# SPDX-License-Identifier: GPL-3.0-or-later
"""Debian systems in folders, each for its Blender, its Python and its libraries.

Their mounts are in a mount namespace of their own, so nothing needs unmounting, however a command ends, and deleting
the cache can never reach through a mount into the project.
"""

import shutil
from dataclasses import dataclass
from pathlib import Path

from layout import CACHE, ROOT
from native_wheel import PIP_WHEEL, inputs, local_version, only_wheel, repair
from shell import DevError, as_root, run, say
from stamp import alone, fingerprint, is_fresh, leave
from wheel_version import LOCAL_PART

PACKAGES = ["blender", "python3-numpy"]
PACKAGES += ["g++", "ccache", "cmake", "ninja-build", "libopenmesh-dev", "libeigen3-dev"]
PACKAGES += ["libnanoflann-dev"]
PACKAGES += ["python3-dev", "python3-pip", "python3-scikit-build-core", "pybind11-dev"]
# a window without a screen, drawn by the processor, and screenshots of it
PACKAGES += ["xvfb", "xauth", "libgl1-mesa-dri", "xdotool", "imagemagick", "fonts-dejavu-core"]

INSIDE = Path("/srv/discrete_fairing")  # a folder that both sides may write
ENTER = ROOT / "build_tools" / "enter_root.sh"
# documents of such a system are not needed, and losing it in a crash does no harm
LEAN = [
    "--dpkgopt=path-exclude=/usr/share/doc/*",
    "--dpkgopt=path-exclude=/usr/share/man/*",
    "--dpkgopt=path-exclude=/usr/share/locale/*",
    "--dpkgopt=force-unsafe-io",
]


@dataclass(frozen=True)
class DebianRoot:
    """One suite of Debian in a folder of the cache."""

    suite: str
    python_tag: str
    extra_packages: tuple[str, ...] = ()
    options: tuple[str, ...] = ()
    # whether its C library is old enough for a manylinux tag of auditwheel
    repairable: bool = True
    # its use, if it is not for Blender
    purpose: str = ""
    base_packages: tuple[str, ...] = tuple(PACKAGES)

    @property
    def place(self) -> str:
        """The name of its folder."""
        return f"debian-{self.suite}{self.purpose and '-'}{self.purpose}"

    @property
    def folder(self) -> Path:
        return CACHE / self.place

    @property
    def outside(self) -> Path:
        """The path of `INSIDE` for programs outside."""
        return self.folder / INSIDE.relative_to("/")

    @property
    def stamp(self) -> Path:
        return CACHE / f"{self.place}.stamp"

    @property
    def ccache(self) -> Path:
        """Its compiler's cache, shared by clones; each compiler has its own."""
        return Path.home() / ".cache" / f"ccache-{self.place}"

    def command(self, *words: str | Path, **extra: str) -> list[str]:
        """The command line that runs `words` inside, as root, with the project read-only at /project."""
        path = "/usr/bin:/bin:/usr/sbin:/sbin"
        variables = {"PATH": path, "HOME": "/root", "LC_ALL": "C.UTF-8", **extra}
        inner = ["env", "-i", *(f"{name}={value}" for name, value in variables.items())]
        inner += map(str, words)
        self.ccache.mkdir(parents=True, exist_ok=True)
        return as_root("unshare", "--mount", "sh", ENTER, self.folder, ROOT, self.ccache, *inner)

    def make(self) -> None:
        """Makes the folder, which takes a minute; returns at once if it exists."""
        with alone(self.place):
            packages = [*self.base_packages, *self.extra_packages]
            value = fingerprint([], self.suite, *packages, *LEAN, *self.options, str(INSIDE))
            if is_fresh(self.stamp, value) and self.folder.is_dir():
                return
            self._bootstrap(packages)
            leave(self.stamp, value)

    def _bootstrap(self, packages: list[str]) -> None:
        if shutil.which("mmdebstrap") is None:
            raise DevError("a Debian in a folder needs mmdebstrap: run `dev.py setup` first.")
        say(
            f"Debian {self.suite} for {self.purpose or 'its Blender'} in {self.folder.relative_to(ROOT)}"
        )
        self.stamp.unlink(missing_ok=True)
        run(*as_root("rm", "-rf", "--one-file-system", self.folder))
        options = ["--variant=minbase", '--aptopt=APT::Install-Recommends "false"']
        options += [*LEAN, *self.options]
        words = ["mmdebstrap", *options, f"--include={','.join(packages)}", self.suite, self.folder]
        if run(*as_root(*words), check=False):
            raise DevError(
                f"no Debian {self.suite} could be made, so nothing can be tested in it: "
                "mmdebstrap needs root, the right to mount, and a reachable Debian archive."
            )
        run(*as_root("mkdir", "-p", self.folder / "project", self.outside))
        run(*as_root("chmod", "1777", self.outside))
        run(*as_root("ln", "-sf", "/proc/self/mounts", self.folder / "etc" / "mtab"))

    def wheel(self) -> Path:
        """The wheel for the Python inside, built there; returns at once if nothing has changed."""
        self.make()
        folder = self.outside / "wheels"
        with alone(f"wheel-{self.suite}"):
            stamp = CACHE / f"wheel-{self.suite}.stamp"
            value = fingerprint(
                inputs(), self.stamp.read_text(), local_version(), str(self.repairable)
            )
            if not (is_fresh(stamp, value) and folder.is_dir()):
                say(f"native build for Debian {self.suite}")
                self._build_wheel(folder)
                leave(stamp, value)
        return only_wheel(folder)

    def _build_wheel(self, folder: Path) -> None:
        raw = self.outside / "unrepaired"
        run(*as_root("rm", "-rf", folder, raw))
        pip = ["python3", "-m", "pip", "--quiet", *PIP_WHEEL]
        pip += [f"--config-settings=build-dir={INSIDE}/build"]
        if not self.repairable:
            pip.append("--config-settings=cmake.define.DF_CARRY_OPENMESH=ON")
        pip += ["--wheel-dir", INSIDE / raw.name, "/project"]
        run(*self.command(*pip, **{LOCAL_PART: local_version(), "PYTHONDONTWRITEBYTECODE": "1"}))
        if self.repairable:
            repair(only_wheel(raw), folder, self.folder / "usr" / "lib" / "x86_64-linux-gnu")
        else:
            shutil.copytree(raw, folder)


ROOTS = (
    DebianRoot("trixie", "cp313"),
    DebianRoot(
        "sid",
        "cp314",
        # Blender's own scripts import these, but its package does not depend on them
        extra_packages=("python3-cattr", "python3-requests", "python3-zstandard"),
        # a mirror that is not updated has an expired index
        options=('--aptopt=Acquire::Check-Valid-Until "false"',),
        repairable=False,
    ),
)
