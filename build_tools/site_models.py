# SPDX-License-Identifier: GPL-3.0-or-later
"""Files for the page with turning surfaces: three.js from Debian, and the models, exported by Blender."""

import shutil
from pathlib import Path

import system_packages
from layout import BUILD, ROOT, VENV_PYTHON
from python_environment import has_bpy
from shell import run, say
from stamp import alone, files_under, fingerprint, is_fresh, leave

THREE = Path("/usr/share/javascript/three")
COPYRIGHT = Path("/usr/share/doc/libjs-three/copyright")
EXAMPLES = "examples/js"
SCRIPTS = [
    "three.min.js",
    f"{EXAMPLES}/loaders/GLTFLoader.js",
    f"{EXAMPLES}/controls/OrbitControls.js",
]
MODELS = BUILD / "site-models"


def add_three(static: Path) -> None:
    """three.js with its licence."""
    with alone("tools"):
        system_packages.install(system_packages.PAGES)
    folder = static / "three"
    folder.mkdir(parents=True)
    for script in SCRIPTS:
        shutil.copy(THREE / script, folder)
    shutil.copy(COPYRIGHT, folder)


def add_models(static: Path) -> None:
    """The models; made again after changes of package, add-on or examples. Without bpy the page has pictures."""
    if not has_bpy():
        say("bpy exists for Python 3.11 only: pictures stand where surfaces would turn.")
        return
    sources = files_under(*(ROOT / name for name in ("addon", "native", "examples")))
    stamp, value = MODELS.with_suffix(".stamp"), fingerprint(sources)
    if not (is_fresh(stamp, value) and MODELS.is_dir()):
        say("models of the site")
        shutil.rmtree(MODELS, ignore_errors=True)
        run(VENV_PYTHON, ROOT / "examples" / "turning_models.py", MODELS)
        leave(stamp, value)
    shutil.copytree(MODELS, static / "models")
