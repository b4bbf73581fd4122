# SPDX-License-Identifier: GPL-3.0-or-later
"""The documents' pictures of Blender's window: parts of what `dev.py test blender` has photographed.

python3 build_tools/window_pictures.py
"""

import shutil

from blender_suite import SCREENSHOTS
from debian_root import ROOTS
from layout import ROOT
from real_blender import of_debian
from shell import run, say

PICTURES = ROOT / "docs" / "images" / "settings"
VIEWPORT = "1262x814+58+84"  # with the sidebar, of a window of 1600 by 1000
# by the names of pictures: the screenshot, the part of it, how wide it becomes
PARTS = {
    "window_surface": ("redo", VIEWPORT, 945),
    "window_live": ("live", VIEWPORT, 945),
    "window_job": ("job_mechanical_zebra", VIEWPORT, 945),
    "window_badge": ("badge", "560x720+1040+24", 560),
}


def main() -> None:
    """All of them, by the ImageMagick of the Debian root that took the screenshots."""
    blender = of_debian(ROOTS[0])
    for name, (screenshot, part, width) in PARTS.items():
        seen, made = blender.exchange / "picture.png", blender.exchange / f"{name}.png"
        # a long script runs in one Blender alone; the older one where both have it
        shutil.copy(sorted(SCREENSHOTS.glob(f"*/{screenshot}.png"))[0], seen)
        words = ["convert", blender.seen(seen), "-crop", part, "+repage", "-resize", f"{width}x"]
        # few colours, as a window has
        words += ["-dither", "None", "-colors", "128", "-strip", blender.seen(made)]
        run(*blender.command(*words))
        shutil.copy(made, PICTURES)
        say(f"{name}.png is ready")


if __name__ == "__main__":
    main()
