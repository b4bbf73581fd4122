# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's zips, one for each Python tag and platform: staged, then built and validated by Blender itself.

Blender wants `__init__.py` beside the manifest, so what lies in addon/ and at the root is laid out anew.
"""

import re
import shutil
import tomllib
import zipfile
from pathlib import Path

import native_wheel
from debian_root import ROOTS
from layout import ADDON, MANIFEST, OUT, ROOT
from real_blender import RealBlender, places
from shell import DevError, run, say
from stamp import alone
from wheel_version import manifest_version

# first Blender whose Python is another one; Debian's own builds have 3.13 in any version
ENDS = {"cp311": "5.1.0"}

LICENCES = ["LICENSE", "THIRD_PARTY_LICENSES.txt"]

# Blender's names of the platforms, by what a wheel calls them
PLATFORMS = {
    r"(many)?linux\w*_x86_64": "linux-x64",
    r"(many)?linux\w*_aarch64": "linux-arm64",
    r"macosx_\w+_x86_64": "macos-x64",
    r"macosx_\w+_arm64": "macos-arm64",
    r"win_amd64": "windows-x64",
    r"win_arm64": "windows-arm64",
}


def python_tag(wheel: Path) -> str:
    """The tag in a wheel's name, "cp311"."""
    return wheel.stem.split("-")[-3]


def platform(wheel: Path) -> str:
    """Blender's name of the platform that a wheel is for, "linux-x64"."""
    tags = wheel.stem.split("-")[-1].split(".")  # auditwheel may give several
    found = {
        name
        for tag in tags
        for pattern, name in PLATFORMS.items()
        if re.fullmatch(pattern, tag, re.ASCII)
    }
    if len(found) != 1:
        raise DevError(
            f"{wheel.name} is for no platform, or for more than one, that Blender knows."
        )
    return found.pop()


def wheel_version(wheel: Path) -> str:
    """The version in a wheel's name, without the local part of a development build."""
    return wheel.stem.split("-")[1].partition("+")[0]


def name(wheel: Path) -> str:
    """What the zip that carries a wheel is called, without the suffix."""
    return f"discrete_fairing-{manifest_version()}-{python_tag(wheel)}-{platform(wheel).replace('-', '_')}"


def staged_manifest(wheel: Path) -> str:
    """The manifest with what only the staging knows, put before its first table."""
    lines = [f'platforms = ["{platform(wheel)}"]', f'wheels = ["./wheels/{wheel.name}"]']
    if python_tag(wheel) in ENDS:
        lines.append(f'blender_version_max = "{ENDS[python_tag(wheel)]}"')
    values, bracket, tables = MANIFEST.read_text().partition("\n[")
    return values.rstrip() + "\n" + "\n".join(lines) + "\n" + bracket + tables


def stage(wheel: Path, folder: Path) -> None:
    """Lays the extension out in a folder that is not there yet."""
    if wheel_version(wheel) != manifest_version():
        raise DevError(
            f"{wheel.name} is not of version {manifest_version()}, which the manifest gives."
        )
    shutil.copytree(ADDON, folder, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "wheels").mkdir()
    shutil.copy(wheel, folder / "wheels")
    for text in LICENCES:
        shutil.copy(ROOT / text, folder)
    (folder / "blender_manifest.toml").write_text(staged_manifest(wheel))


def faults(path: Path) -> list[str]:
    """What is wrong with a zip that Blender's own validation would let pass."""
    with zipfile.ZipFile(path) as archive:
        names = set(archive.namelist())
        manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
    wheels = [entry.removeprefix("./") for entry in manifest.get("wheels", [])]
    carried = [entry for entry in names if entry.endswith(".whl")]
    tagline = manifest["tagline"]
    checks = {
        "the version is not the project's": manifest["version"] == manifest_version(),
        "not exactly one wheel": len(wheels) == 1 and carried == wheels,
        "the wheel has another version": all(
            wheel_version(Path(w)) == manifest["version"] for w in wheels
        ),
        "the wheel is for another platform": [platform(Path(w)) for w in wheels]
        == manifest["platforms"],
        "a permission that is not used": "permissions" not in manifest,
        "the tagline is too long or ends in a period": len(tagline) <= 64
        and not tagline.endswith("."),
        "no licence": names.issuperset(LICENCES),
        "compiled Python": not any(
            "__pycache__" in entry or entry.endswith(".pyc") for entry in names
        ),
    }
    return [fault for fault, fine in checks.items() if not fine]


def build(wheel: Path, blender: RealBlender) -> Path:
    """One zip, built and validated by `blender`; it is left in the folder common with Blender."""
    source = blender.exchange / name(wheel)
    made = blender.exchange / f"{name(wheel)}.zip"
    shutil.rmtree(source, ignore_errors=True)
    stage(wheel, source)
    where = ["--source-dir", blender.seen(source), "--output-filepath", blender.seen(made)]
    run(*blender.headless("--command", "extension", "build", *where))
    run(*blender.headless("--command", "extension", "validate", blender.seen(made)))
    if found := faults(made):
        raise DevError(f"{made.name}: {'; '.join(found)}.")
    return made


def wheels_at_hand() -> list[Path]:
    """The wheels for .venv and for each Debian root; for one tag and platform the first one counts."""
    wheels = [native_wheel.install(), *(root.wheel() for root in ROOTS)]
    return list({name(wheel): wheel for wheel in reversed(wheels)}.values())[::-1]


def wheels_in(folder: Path) -> list[Path]:
    """The wheels that were made elsewhere."""
    wheels = sorted(folder.glob("discrete_fairing-*.whl"))
    if not wheels:
        raise DevError(f"there is no wheel of discrete_fairing in {folder}.")
    if len({name(wheel) for wheel in wheels}) != len(wheels):
        raise DevError(f"{folder} has two wheels for the same Python and platform.")
    return wheels


def build_all(wheels: list[Path]) -> list[Path]:
    """A zip for each wheel, under out/, made by a Blender with the wheel's Python where there is one."""
    folder = OUT / "extension"
    with alone("blender"):
        blenders = [get() for get in places().values()]
        for blender in blenders:
            blender.clear()
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        made = []
        for wheel in wheels:
            say(f"extension {name(wheel)}")
            fitting = [blender for blender in blenders if blender.python_tag == python_tag(wheel)]
            made.append(Path(shutil.copy(build(wheel, (fitting or blenders)[0]), folder)))
    return made
