# SPDX-License-Identifier: GPL-3.0-or-later
"""The documents' pictures of Blender's window: parts of screenshots by scripts of tests/blender/."""

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
# by the picture's name: the script, its screenshot, the part, the width of the result
PARTS = {
    "window_surface": ("window_run.py", "redo", VIEWPORT, 945),
    "window_live": ("window_live.py", "live", VIEWPORT, 945),
    "window_job": ("window_jobs.py", "job_mechanical_zebra", VIEWPORT, 945),
    "window_badge": ("window_undo.py", "badge", "560x720+1040+24", 560),
}
COLOURS = ("-dither", "None", "-colors", "128", "-strip")


def cut(name: str) -> None:
    """Takes one screenshot again, and cuts out the picture by ImageMagick in the Debian root."""
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
