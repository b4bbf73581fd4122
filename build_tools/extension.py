# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's zips, one for each Python tag: staged in a folder, then built and validated by Blender itself.

Blender wants `__init__.py` beside the manifest, so what lies in addon/ and at the root is laid out anew.
"""

import shutil
from pathlib import Path

import debian_root
import native_wheel
from layout import ADDON, BUILD, MANIFEST, OUT, ROOT
from real_blender import RealBlender, find
from shell import run, say
from wheel_version import manifest_version

# first Blender whose Python is another one; Debian's own builds have 3.13 in any version
ENDS = {"cp311": "5.1.0"}


def python_tag(wheel: Path) -> str:
    """The tag in a wheel's name, "cp311"."""
    return wheel.stem.split("-")[-3]


def staged_manifest(wheel: Path) -> str:
    """The manifest with what only the staging knows, put before its first table."""
    lines = ['platforms = ["linux-x64"]', f'wheels = ["./wheels/{wheel.name}"]']
    if python_tag(wheel) in ENDS:
        lines.append(f'blender_version_max = "{ENDS[python_tag(wheel)]}"')
    values, bracket, tables = MANIFEST.read_text().partition("\n[")
    return values.rstrip() + "\n" + "\n".join(lines) + "\n" + bracket + tables


def stage(wheel: Path) -> Path:
    """Lays the extension out in a folder."""
    folder = BUILD / "extension" / python_tag(wheel)
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ADDON, folder, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "wheels").mkdir()
    shutil.copy(wheel, folder / "wheels")
    shutil.copy(ROOT / "LICENSE", folder)
    (folder / "blender_manifest.toml").write_text(staged_manifest(wheel))
    return folder


def build(wheel: Path, blender: RealBlender) -> Path:
    """One zip, built and validated by `blender`; it is left in the folder common with Blender."""
    exchange = blender.folder / "exchange"
    source = exchange / python_tag(wheel)
    shutil.copytree(stage(wheel), source)
    made = exchange / f"discrete_fairing-{manifest_version()}-{python_tag(wheel)}-linux_x64.zip"
    places = ["--source-dir", blender.seen(source), "--output-filepath", blender.seen(made)]
    run(*blender.command("--command", "extension", "build", *places))
    run(*blender.command("--command", "extension", "validate", blender.seen(made)))
    return made


def build_all() -> list[Path]:
    """A zip for each Python at hand, under out/."""
    blender = find()
    blender.clear()
    wheels = {python_tag(wheel): wheel for wheel in (debian_root.wheel(), native_wheel.install())}
    folder = OUT / "extension"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    say("extension for " + ", ".join(wheels))
    return [Path(shutil.copy(build(wheel, blender), folder)) for wheel in wheels.values()]
