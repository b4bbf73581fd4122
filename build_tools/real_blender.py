# SPDX-License-Identifier: GPL-3.0-or-later
"""Real Blenders to build, validate and try the extension in: those of the Debian roots, and the machine's own."""

import re
import shutil
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import native_wheel
from debian_root import INSIDE, ROOTS, DebianRoot
from layout import BUILD, VENV_PYTHON
from shell import DevError, as_root, output, run, say

OLDEST = (4, 3)
ASK = "import bpy, sys; print('is', bpy.app.version_string, 'cp%d%d' % sys.version_info[:2])"
WINDOW = (1600, 1000)
FIRST_SCREEN = 70
# sockets in the root's own folder alone: those without a folder would be common to all roots of a machine
SCREEN = "-screen 0 {}x{}x24 -nolisten local"
TIME_LIMIT = 600  # seconds: a Blender that is not done then hangs


@dataclass(frozen=True)
class RealBlender:
    """A Blender, and a folder that it and we can write."""

    version: str
    python_tag: str
    folder: Path  # as we see it
    inside: Path  # as Blender sees it
    root: DebianRoot | None = None  # None: the machine's own
    # of several that run at the same time, each with settings and a screen of its own
    lane: int = 0

    @property
    def exchange(self) -> Path:
        """Where files for Blender and from it lie, as we see it."""
        return self.folder / "exchange"

    @property
    def user(self) -> str:
        """The name of the user's folder in the common one."""
        return f"user-{self.lane}"

    def lanes(self, count: int) -> "list[RealBlender]":
        """So many of this Blender that may run at the same time, all with what is installed now."""
        found = [replace(self, lane=lane) for lane in range(count)]
        for other in found[1:]:
            copied = ["cp", "--archive", self.folder / self.user, self.folder / other.user]
            run(*as_root("rm", "-rf", copied[-1]))
            run(*as_root(*copied))
        return found

    def command(self, *words: str | Path, **extra: str) -> list[str]:
        """The command line of a program beside this Blender, isolated from the user's settings.

        timeout(1) ends it in time, with all that it started.
        """
        variables = {"BLENDER_USER_RESOURCES": str(self.inside / self.user), **extra}
        limited = ["timeout", "--kill-after=10", str(TIME_LIMIT), *map(str, words)]
        if self.root:
            return self.root.command(*limited, **variables)
        return ["env", *(f"{name}={value}" for name, value in variables.items()), *limited]

    def headless(self, *arguments: str | Path, **extra: str) -> list[str]:
        """The command line of Blender without a window."""
        return self.command("blender", "--background", *arguments, **extra)

    def window(
        self, *arguments: str | Path, size: tuple[int, int] = WINDOW, **extra: str
    ) -> list[str]:
        """The command line of Blender in a window on a screen of its own, drawn by the processor."""
        width, height = map(str, size)
        number = FIRST_SCREEN + self.lane
        screen = ["xvfb-run", f"--server-num={number}"]
        screen += ["--server-args", SCREEN.format(width, height)]
        blender = ["blender", "--window-geometry", "0", "0", width, height, *arguments]
        return self.command(*screen, *blender, LIBGL_ALWAYS_SOFTWARE="1", **extra)

    def has_screen(self) -> bool:
        """Whether windows can be opened and photographed: the Debian roots have what it takes."""
        return self.root is not None

    def wheel(self) -> Path:
        """The wheel for this Blender's Python."""
        return self.root.wheel() if self.root else native_wheel.install()

    def clear(self) -> None:
        """Empties the common folder, but for what the Debian root keeps there."""
        old = [*self.folder.glob("user*"), self.exchange]
        run(*as_root("rm", "-rf", *old))
        self.exchange.mkdir(parents=True)
        self.exchange.chmod(0o777)

    def seen(self, path: Path) -> Path:
        """A path in the common folder as Blender sees it."""
        return self.inside / path.relative_to(self.folder)


def venv_tag() -> str:
    """The tag of .venv's Python, "cp311"."""
    ask_tag = "import sys; print('cp%d%d' % sys.version_info[:2])"
    return output(VENV_PYTHON, "-c", ask_tag)[1].strip()


def ask(command: list[str]) -> tuple[tuple[str, str] | None, str]:
    """Version and Python tag of a Blender, None if it does not run, and what it said."""
    _, text = output(*command, "--background", "--factory-startup", "--python-expr", ASK)
    found = re.search(r"^is (\S+).* (cp\d+)$", text, re.MULTILINE)
    return (found[1], found[2]) if found else None, text


def on_path() -> RealBlender | None:
    """The machine's own Blender, if it is new enough and its Python is the one that .venv builds for."""
    if shutil.which("blender") is None:
        return None
    facts, _ = ask(["blender"])
    if facts is None or facts[1] != venv_tag():
        return None
    if tuple(int(part) for part in facts[0].split(".")[:2]) < OLDEST:
        return None
    folder = BUILD / "real-blender"
    return RealBlender(*facts, folder=folder, inside=folder)


def of_debian(root: DebianRoot) -> RealBlender:
    """Blender in a Debian root, which is made if need be."""
    root.make()
    facts, text = ask(root.command("blender"))
    if facts is None:
        raise DevError(
            f"Blender does not start in {root.folder} (entering it needs root and the right to mount): "
            f"{text.strip()[-500:]}"
        )
    if facts[1] != root.python_tag:
        raise DevError(f"Debian {root.suite} has moved on to {facts[1]}: say so in debian_root.py.")
    say(f"real Blender {facts[0]}, {facts[1]}, of Debian {root.suite}")
    return RealBlender(*facts, folder=root.outside, inside=INSIDE, root=root)


def places() -> dict[str, Callable[[], RealBlender]]:
    """How to reach each Blender that is available, by the name of its place; those of Debian always are."""
    found: dict[str, Callable[[], RealBlender]] = {
        root.suite: partial(of_debian, root) for root in ROOTS
    }
    own = on_path()
    return {"path": lambda: own, **found} if own else found
