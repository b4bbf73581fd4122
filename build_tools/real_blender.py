# SPDX-License-Identifier: GPL-3.0-or-later
"""Real Blenders in the Debian roots, which build, validate and test the extension."""

import re
from dataclasses import dataclass, replace
from pathlib import Path

from debian_root import INSIDE, DebianRoot
from shell import DevError, as_root, output, run, say

ASK = "import bpy, sys; print('is', bpy.app.version_string, 'cp%d%d' % sys.version_info[:2])"
WINDOW = (1600, 1000)
FIRST_SCREEN = 70
# sockets in the root's own folder only: others would be shared by all roots of a machine
SCREEN = "-screen 0 {}x{}x24 -nolisten local"
TIME_LIMIT = 900  # seconds, after which a Blender counts as hanging


@dataclass(frozen=True)
class RealBlender:
    """A Blender of a Debian root."""

    version: str
    root: DebianRoot
    # one of several that run at the same time, each with its own settings and screen
    lane: int = 0

    @property
    def folder(self) -> Path:
        """The shared folder, as seen from outside; `INSIDE` for Blender."""
        return self.root.outside

    @property
    def exchange(self) -> Path:
        """The folder for files to and from Blender, as seen from outside."""
        return self.folder / "exchange"

    @property
    def user(self) -> str:
        """The name of the user's folder in the shared one."""
        return f"user-{self.lane}"

    def lanes(self, count: int) -> "list[RealBlender]":
        """Copies of this Blender, with everything installed now, that may run at the same time."""
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
        variables = {"BLENDER_USER_RESOURCES": str(INSIDE / self.user), **extra}
        limited = ["timeout", "--kill-after=10", str(TIME_LIMIT), *map(str, words)]
        return self.root.command(*limited, **variables)

    def headless(self, *arguments: str | Path, **extra: str) -> list[str]:
        """The command line of Blender without a window."""
        return self.command("blender", "--background", *arguments, **extra)

    def window(
        self, *arguments: str | Path, size: tuple[int, int] = WINDOW, **extra: str
    ) -> list[str]:
        """The command line of Blender in a window on its own screen, drawn by the processor."""
        width, height = map(str, size)
        number = FIRST_SCREEN + self.lane
        screen = ["xvfb-run", f"--server-num={number}"]
        screen += ["--server-args", SCREEN.format(width, height)]
        blender = ["blender", "--window-geometry", "0", "0", width, height, *arguments]
        return self.command(*screen, *blender, LIBGL_ALWAYS_SOFTWARE="1", **extra)

    def clear(self) -> None:
        """Empties the shared folder, except for files of the Debian root."""
        old = [*self.folder.glob("user*"), self.exchange]
        run(*as_root("rm", "-rf", *old))
        self.exchange.mkdir(parents=True)
        self.exchange.chmod(0o777)

    def seen(self, path: Path) -> Path:
        """A path in the shared folder as seen by Blender."""
        return INSIDE / path.relative_to(self.folder)


def of_debian(root: DebianRoot) -> RealBlender:
    """Blender in a Debian root, which is made if missing."""
    root.make()
    asking = ["--background", "--factory-startup", "--python-expr", ASK]
    _, text = output(*root.command("blender", *asking))
    found = re.search(r"^is (\S+).* (cp\d+)$", text, re.MULTILINE)
    if found is None:
        raise DevError(
            f"Blender does not start in {root.folder} (entering it needs root and the right to mount): "
            f"{text.strip()[-500:]}"
        )
    version, python = found.groups()
    if python != root.python_tag:
        raise DevError(f"Debian {root.suite} has moved on to {python}: say so in debian_root.py.")
    say(f"real Blender {version}, {python}, of Debian {root.suite}")
    return RealBlender(version, root)
