# SPDX-License-Identifier: GPL-3.0-or-later
"""Remakes the pictures of the documents; docs/developers/pictures.md has the date of each."""

import re
import time
from collections.abc import Iterable
from pathlib import Path

import recordings
import window_pictures
from layout import ROOT, VENV_PYTHON
from shell import DevError, output, run, say
from wheel_version import manifest_version

IMAGES = ROOT / "docs" / "images"
PAGE = ROOT / "docs" / "developers" / "pictures.md"
HEAD = """# Pictures

`python3 build_tools/dev.py pictures` makes all of them again, `pictures hull` those whose names contain *hull*. Each has the
version, the commit and the day that it shows. A test fails if a picture is missing here, is on no page, or shows an older
version.

| Picture | Made by | Shows |
|---|---|---|
"""
ROW = re.compile(r"^\| \[(\S+)\]\(\S+\) \| (.+) \| (\S+), `(\w+)`, (\S+) \|$", re.MULTILINE)
# the script of each folder, which is called with the picture's name; or of a single picture
SCRIPTS = {
    "convergence.png": "benchmarks/plot_convergence.py",
    "pads.png": "examples/gallery.py",
    "curves": "examples/render_curves.py",
    "filling": "examples/render_fills.py",
    "gallery": "examples/gallery.py",
    "jobs": "examples/render_jobs.py",
    "settings": "examples/render_settings.py",
    "splines": "examples/render_splines.py",
    "tutorials": "examples/render_tutorials.py",
}
PLOTS = "benchmarks/plot_"  # scripts that draw one picture each
WINDOWS, RECORDINGS = "build_tools/window_pictures.py", "build_tools/recordings.py"
BY_HAND = {"splines/freecad.png": "a photograph of FreeCAD's window"}


def maker(name: str) -> str:
    """The command that makes a picture, without `python`."""
    if name in BY_HAND:
        return BY_HAND[name]
    folder, _, file = name.rpartition("/")
    stem = file.rpartition(".")[0]
    if file.endswith(".gif"):
        return f"{RECORDINGS} {stem}"
    if stem.startswith("window_"):
        return f"{WINDOWS} {stem}"
    script = SCRIPTS[name] if name in SCRIPTS else SCRIPTS[folder]
    return script if script.startswith(PLOTS) else f"{script} {stem}"


def pictures() -> list[str]:
    """The names of all pictures in docs/images."""
    found = [path for path in IMAGES.rglob("*") if path.suffix in (".png", ".gif")]
    return sorted(path.relative_to(IMAGES).as_posix() for path in found)


def rows(text: str) -> dict[str, tuple[str, str, str, str]]:
    """By picture: the command that made it, and the version, commit and day that it shows."""
    return {name: (by.strip("`"), *shows) for name, by, *shows in ROW.findall(text)}


def page(made: dict[str, tuple[str, str, str, str]]) -> str:
    """The page's text."""
    lines = [
        f"| [{name}](../images/{name}) | {by if name in BY_HAND else f'`{by}`'} | {version}, `{commit}`, {day} |"
        for name, (by, version, commit, day) in sorted(made.items())
    ]
    return HEAD + "\n".join(lines) + "\n"


def note(names: Iterable[str]) -> None:
    """Writes the present date for these pictures; pictures that no longer exist are removed from the page."""
    code, commit = output("git", "log", "-1", "--format=%h")
    if code != 0:
        raise DevError("pictures are dated by a git commit.")
    now = (manifest_version(), commit.strip(), time.strftime("%Y-%m-%d"))
    old = rows(PAGE.read_text("utf-8")) if PAGE.exists() else {}
    made = {name: old[name] for name in pictures() if name in old}
    made |= {name: (maker(name), *now) for name in names}
    PAGE.write_text(page(made), "utf-8")


def draw(name: str, meshes: Path | None) -> None:
    """Makes one picture; its script leaves it unchanged if its requirements are missing."""
    script, *arguments = maker(name).split()
    if script == RECORDINGS:
        recordings.record(*arguments, IMAGES / name)
    elif script == WINDOWS:
        window_pictures.cut(*arguments)
    else:
        extra = ["--meshes", meshes] if meshes and script.endswith("gallery.py") else []
        run(VENV_PYTHON, ROOT / script, *arguments, *extra)


def make(wanted: list[str], meshes: Path | None) -> int:
    """Makes and dates all pictures whose names contain one of `wanted`; all if there is none."""
    chosen = [name for name in pictures() if any(w in name for w in wanted) or not wanted]
    if not chosen:
        raise DevError(f"no picture is named so: {', '.join(wanted)}.")
    left = [name for name in chosen if name in BY_HAND]
    for name in chosen:
        path = IMAGES / name
        before = path.stat().st_mtime_ns
        if name not in left:
            draw(name, meshes)
        if path.stat().st_mtime_ns > before:
            note([name])
        else:
            left.append(name)
    say(f"left as they are: {', '.join(dict.fromkeys(left)) or 'none'}")
    return 0
