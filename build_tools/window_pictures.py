# SPDX-License-Identifier: GPL-3.0-or-later
"""The documents' pictures of Blender's window: parts of what the scripts of tests/blender/ photograph."""

import shutil
from collections.abc import Iterable

from blender_suite import SCREENSHOTS, install, try_all
from debian_root import ROOTS
from layout import ROOT
from real_blender import of_debian
from shell import DevError, run
from stamp import alone

PICTURES = ROOT / "docs" / "images" / "settings"
VIEWPORT = "1262x814+58+84"  # with the sidebar, of a window of 1600 by 1000
# by the names of pictures: the script, its screenshot, the part of it, how wide it becomes
PARTS = {
    "window_surface": ("window_run.py", "redo", VIEWPORT, 945),
    "window_live": ("window_live.py", "live", VIEWPORT, 945),
    "window_job": ("window_jobs.py", "job_mechanical_zebra", VIEWPORT, 945),
    "window_badge": ("window_follows.py", "badge", "560x720+1040+24", 560),
}
# few colours, as a window has
COLOURS = ("-dither", "None", "-colors", "128", "-strip")


def cut(name: str) -> None:
    """One picture, photographed anew and cut by the ImageMagick of the Debian root."""
    script, screenshot, part, width = PARTS[name]
    with alone("blender"):
        blender = install(of_debian(ROOTS[0]))
        tally = try_all(blender, script, set())
        taken = SCREENSHOTS / blender.version / f"{screenshot}.png"
        if not taken.is_file():
            raise DevError(f"{script} has taken no {screenshot}: {tally}")
        seen, made = blender.exchange / "picture.png", blender.exchange / f"{name}.png"
        shutil.copy(taken, seen)
        words: Iterable[object] = ("-crop", part, "+repage", "-resize", f"{width}x", *COLOURS)
        command = ["convert", blender.seen(seen), *map(str, words), blender.seen(made)]
        run(*blender.command(*command))
        shutil.copy(made, PICTURES)
