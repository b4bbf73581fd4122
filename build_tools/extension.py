# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the extension's zips, one for each platform: staged, then built and validated by Blender itself.

Blender requires `__init__.py` beside the manifest, so addon/ and the root are combined in one folder.
"""

import re
import shutil
from pathlib import Path

import native_wheel
from debian_root import ROOTS
from layout import ADDON, MANIFEST, OUT, ROOT
from real_blender import RealBlender, of_debian
from shell import DevError, run, say
from stamp import alone
from wheel_version import manifest_version

# the first Blender with the next version of Python; Debian's own builds have 3.13 in any version
ENDS = {"cp311": "5.1.0"}

LICENCES = ["LICENSE", "THIRD_PARTY_LICENSES.txt"]

# Blender's names of platforms, by the platform tag of a wheel
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
    kinds = PLATFORMS.items()
    found = {name for tag in tags for kind, name in kinds if re.fullmatch(kind, tag, re.ASCII)}
    if len(found) != 1:
        raise DevError(f"{wheel.name} is for no platform, or for several, that Blender knows.")
    return found.pop()


def wheel_version(wheel: Path) -> str:
    """The version in a wheel's name, without the local part of a development build."""
    return wheel.stem.split("-")[1].partition("+")[0]


def only_platform(wheels: list[Path]) -> str:
    """Blender's name of the one platform that the wheels of a zip are for."""
    found = {platform(wheel) for wheel in wheels}
    if len(found) != 1 or len(set(map(python_tag, wheels))) != len(wheels):
        names = ", ".join(wheel.name for wheel in wheels)
        raise DevError(f"a zip holds wheels of one platform, one a Python: {names}.")
    return found.pop()


def name(wheels: list[Path]) -> str:
    """The name of the zip with these wheels, without the suffix."""
    tags = [*map(python_tag, wheels)]
    python = f"{tags[0]}-" if len(tags) == 1 else ""
    place = only_platform(wheels).replace("-", "_")
    return f"discrete_fairing-{manifest_version()}-{python}{place}"


def added_lines(wheels: list[Path]) -> dict[str, str]:
    """Lines of the manifest that are known only after staging."""
    paths = ", ".join(f'"./wheels/{wheel.name}"' for wheel in wheels)
    lines = {"platforms": f'["{only_platform(wheels)}"]', "wheels": f"[{paths}]"}
    ends = [ENDS.get(python_tag(wheel)) for wheel in wheels]
    if None not in ends:
        lines["blender_version_max"] = f'"{max(ends)}"'
    return lines


def staged_manifest(wheels: list[Path]) -> str:
    """The manifest with these lines before its first table."""
    added = added_lines(wheels)
    values, bracket, tables = MANIFEST.read_text().partition("\n[")
    kept = [line for line in values.splitlines() if line.partition(" = ")[0] not in added]
    lines = [*kept, *(f"{key} = {value}" for key, value in added.items())]
    return "\n".join(lines) + "\n" + bracket + tables


def stage(wheels: list[Path], folder: Path) -> None:
    """Copies the extension's files to a folder that does not exist yet."""
    for wheel in wheels:
        if wheel_version(wheel) != manifest_version():
            raise DevError(f"{wheel.name} is not of the manifest's version {manifest_version()}.")
    shutil.copytree(ADDON, folder, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "wheels").mkdir()
    for wheel in wheels:
        shutil.copy(wheel, folder / "wheels")
    for text in LICENCES:
        shutil.copy(ROOT / text, folder)
    (folder / "blender_manifest.toml").write_text(staged_manifest(wheels))


def build(wheels: list[Path], blender: RealBlender) -> Path:
    """One zip, built and validated by `blender`; it stays in the folder shared with Blender."""
    source = blender.exchange / name(wheels)
    made = blender.exchange / f"{name(wheels)}.zip"
    shutil.rmtree(source, ignore_errors=True)
    stage(wheels, source)
    where = ["--source-dir", blender.seen(source), "--output-filepath", blender.seen(made)]
    run(*blender.headless("--command", "extension", "build", *where))
    run(*blender.headless("--command", "extension", "validate", blender.seen(made)))
    return made


def by_platform(wheels: list[Path]) -> list[list[Path]]:
    """The wheels of each zip: one zip for each platform, with the wheels of all its Pythons."""
    platforms = dict.fromkeys(platform(wheel) for wheel in wheels)
    return [[wheel for wheel in wheels if platform(wheel) == each] for each in platforms]


def wheels_at_hand() -> list[list[Path]]:
    """The wheels for .venv and for each Debian root, each for its own zip; duplicates are dropped."""
    wheels = [native_wheel.install(), *(root.wheel() for root in ROOTS)]
    first = {name([wheel]): wheel for wheel in reversed(wheels)}
    return [[wheel] for wheel in reversed(first.values())]


def zips(folder: Path | None, names: list[str] | None = None) -> list[list[Path]]:
    """The wheels in a folder or, without one, those compiled for the named platforms or for all; by platform."""
    from cross.targets import TARGETS, target_named
    from cross.wheels import build as compile_for

    if folder is not None:
        return wheels_in(folder.resolve())
    targets = [target_named(name) for name in names] if names else TARGETS
    return by_platform([wheel for target in targets for wheel in compile_for(target)])


def wheels_in(folder: Path) -> list[list[Path]]:
    """The wheels in a folder, by platform."""
    wheels = sorted(folder.glob("discrete_fairing-*.whl"))
    if not wheels:
        raise DevError(f"there is no wheel of discrete_fairing in {folder}.")
    if len({name([wheel]) for wheel in wheels}) != len(wheels):
        raise DevError(f"{folder} has two wheels for the same Python and platform.")
    return by_platform(wheels)


def build_all(zips: list[list[Path]]) -> list[Path]:
    """A zip for each list of wheels, under out/, built by a Blender with a wheel's Python if there is one."""
    folder = OUT / "extension"
    with alone("blender"):
        blenders = [of_debian(root) for root in ROOTS]
        for blender in blenders:
            blender.clear()
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        made = []
        for wheels in zips:
            say(f"extension {name(wheels)}")
            fitting = [each for each in blenders if each.root.python_tag in map(python_tag, wheels)]
            made.append(Path(shutil.copy(build(wheels, (fitting or blenders)[0]), folder)))
    return made
