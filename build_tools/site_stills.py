# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures that stand where no surface can turn: Chromium draws the site's own figures on no background.

python3 build_tools/site_stills.py        all of them, to docs/site/stills/; needs a built site (`dev.py docs`)
"""

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

from browser import photograph
from layout import ROOT
from serving import served
from site_pages import SITE

STILLS = ROOT / "docs" / "site" / "stills"
SIZE = (800, 500)
PAGE = """<!DOCTYPE html><link rel="stylesheet" href="turning.css">
<style>body, figure.turning {{ margin: 0 }} .turning-choices {{ display: none }}</style>
<figure class="turning"><img src="turning_{name}.png" alt=""></figure>
<script src="three/three.min.js"></script><script src="three/GLTFLoader.js"></script>
<script src="three/OrbitControls.js"></script><script src="turning.js"></script>"""


def main() -> None:
    """Draws a picture of each model."""
    with TemporaryDirectory() as made:
        static = Path(made) / "static"
        shutil.copytree(SITE / "_static", static)
        models = sorted(path.stem for path in (static / "models").glob("*.glb"))
        with served(static) as address:
            for name in models:
                (static / f"{name}.html").write_text(PAGE.format(name=name), "utf-8")
                clear = "--default-background-color=00000000"
                photograph(f"{address}/{name}.html", STILLS / f"turning_{name}.png", SIZE, clear)


if __name__ == "__main__":
    main()
