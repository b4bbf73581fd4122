# SPDX-License-Identifier: GPL-3.0-or-later
"""The recordings of the pages: examples/record_trades.py takes the pictures, ImageMagick makes a GIF of them."""

import json
import shutil
from pathlib import Path

from blender_suite import install
from debian_root import ROOTS
from layout import ROOT
from real_blender import of_debian
from shell import DevError, run
from stamp import alone

SCRIPT = Path("examples") / "record_trades.py"
NEEDED = ("tests/blender", "examples", "docs/trades", "docs/how-to")
WINDOW = (960, 720)
WIDTH = 720  # of a recording
COLOURS = 128
TICK = 12  # hundredths of a second a frame
ARROW = ((0, 0), (0, 17), (4, 13), (7, 20), (10, 19), (7, 12), (12, 12))


def pointer(x: float, y: float, pressed: bool) -> list[str]:
    """What draws the pointer, with a ring while its button is down."""
    corners = " ".join(f"{x + dx:.1f},{y + dy:.1f}" for dx, dy in ARROW)
    words = ["-fill", "white", "-stroke", "black", "-draw", f"polygon {corners}"]
    if pressed:
        words += ["-fill", "none", "-stroke", "#f5a623", "-strokewidth", "2"]
        words += ["-draw", f"circle {x:.1f},{y:.1f} {x + 12:.1f},{y:.1f}", "-strokewidth", "1"]
    return words


def animation(taken: dict, folder: Path) -> list[str]:
    """The words after `convert` that make a GIF of what was taken: equal colours in all frames, few bytes."""
    width, height, left, top = taken["crop"]
    scale = WIDTH / width
    words: list[str] = []
    for picture, x, y, stays, pressed in taken["frames"]:
        words += ["(", str(folder / picture), "-crop", f"{width}x{height}+{left}+{top}", "+repage"]
        words += ["-resize", f"{WIDTH}x", *pointer(scale * (x - left), scale * (y - top), pressed)]
        words += ["-set", "delay", str(TICK * stays), ")"]
    return [*words, "-dither", "None", "-remap", str(folder / "palette.png"), "-loop", "0"]


def palette(taken: dict, folder: Path) -> list[str]:
    """The words after `convert` that choose the colours of all frames together."""
    width, height, left, top = taken["crop"]
    pictures = sorted({frame[0] for frame in taken["frames"]})
    words = [*(str(folder / name) for name in pictures), "-crop", f"{width}x{height}+{left}+{top}"]
    words += ["+repage", "-resize", "25%", "-append"]
    return [*words, "-colors", str(COLOURS), "-unique-colors"]


def record(name: str, target: Path) -> None:
    """The GIF of one recording, in a real Blender's window."""
    with alone("blender"):
        blender = install(of_debian(ROOTS[0]))
        for part in NEEDED:
            shutil.copytree(ROOT / part, blender.exchange / part)
        (shots := blender.exchange / "screenshots").mkdir()
        shots.chmod(0o777)
        seen, script = blender.seen(shots), blender.seen(blender.exchange / SCRIPT)
        words = ["--python", script, "--", name]
        run(*blender.window(*words, size=WINDOW, DF_SCREENSHOTS=str(seen)))
        if not (shots / "frames.json").is_file():
            raise DevError(f"no recording of {name}: what Blender said is above.")
        taken = json.loads((shots / "frames.json").read_text())
        run(*blender.command("convert", *palette(taken, seen), seen / "palette.png"))
        optimized = ["-layers", "OptimizeTransparency", seen / "film.gif"]
        run(*blender.command("convert", *animation(taken, seen), *optimized))
        shutil.copy(shots / "film.gif", target)
