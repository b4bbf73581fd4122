# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Blender to build, validate and try the extension in: the machine's own, or Debian trixie's."""

import re
import shutil
from dataclasses import dataclass
from pathlib import Path

import debian_root
import native_wheel
from layout import BUILD, VENV_PYTHON
from shell import DevError, as_root, output, run, say

OLDEST = (4, 2)
ASK = "import bpy, sys; print('is', bpy.app.version_string, 'cp%d%d' % sys.version_info[:2])"


@dataclass(frozen=True)
class RealBlender:
    """A Blender, and a folder that it and we can write."""

    version: str
    python_tag: str
    folder: Path  # as we see it
    inside: Path  # as Blender sees it
    in_debian_root: bool

    def command(self, *arguments: str | Path, **extra: str) -> list[str]:
        """The command line for this Blender, isolated from the user's settings."""
        variables = {"BLENDER_USER_RESOURCES": str(self.inside / "user"), **extra}
        words = ["blender", "--background", *map(str, arguments)]
        if self.in_debian_root:
            return debian_root.command(*words, **variables)
        return ["env", *(f"{name}={value}" for name, value in variables.items()), *words]

    def wheel(self) -> Path:
        """The wheel for this Blender's Python."""
        return debian_root.wheel() if self.in_debian_root else native_wheel.install()

    def clear(self) -> None:
        """Empties the common folder, but for what the Debian root keeps there."""
        for name in ("user", "exchange"):
            run(*as_root("rm", "-rf", self.folder / name))
        (self.folder / "exchange").mkdir(parents=True)
        (self.folder / "exchange").chmod(0o777)

    def seen(self, path: Path) -> Path:
        """A path in the common folder as Blender sees it."""
        return self.inside / path.relative_to(self.folder)


def venv_tag() -> str:
    """The tag of .venv's Python, "cp311"."""
    return output(VENV_PYTHON, "-c", "import sys; print('cp%d%d' % sys.version_info[:2])")[1].strip()


def ask(command: list[str]) -> tuple[tuple[str, str] | None, str]:
    """Version and Python tag of a Blender, None if it does not run, and what it said."""
    _, text = output(*command, "--python-expr", ASK)
    found = re.search(r"^is (\S+).* (cp\d+)$", text, re.MULTILINE)
    return (found[1], found[2]) if found else None, text


def on_path() -> RealBlender | None:
    """The machine's own Blender, if it is new enough and its Python is the one that .venv builds for."""
    if shutil.which("blender") is None:
        return None
    facts, _ = ask(["blender", "--background", "--factory-startup"])
    if facts is None or facts[1] != venv_tag():
        return None
    if tuple(int(part) for part in facts[0].split(".")[:2]) < OLDEST:
        return None
    folder = BUILD / "real-blender"
    return RealBlender(*facts, folder=folder, inside=folder, in_debian_root=False)


def of_debian() -> RealBlender:
    """Blender in the Debian root, which is made if need be."""
    debian_root.make()
    facts, text = ask(debian_root.command("blender", "--background", "--factory-startup"))
    if facts is None:
        raise DevError(
            f"Blender does not start in {debian_root.FOLDER} (entering it needs root and the right to mount): "
            f"{text.strip()[-500:]}"
        )
    return RealBlender(*facts, folder=debian_root.OUTSIDE, inside=debian_root.INSIDE, in_debian_root=True)


def find() -> RealBlender:
    """A Blender to test in; the machine's own comes first."""
    blender = on_path() or of_debian()
    say(f"real Blender {blender.version}, {blender.python_tag}")
    return blender
