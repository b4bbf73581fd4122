# SPDX-License-Identifier: GPL-3.0-or-later
"""Wheels for other platforms: the package's Python files, a cross-compiled module, and metadata like pip's."""

import re
import shutil
import tempfile
from pathlib import Path

from layout import CACHE, ROOT, VENV_PYTHON
from native_wheel import inputs, local_version, only_wheel
from shell import DevError, output, run, say
from stamp import alone, files_under, fingerprint, is_fresh, leave
from wheel_version import LOCAL_PART

from cross import native_build
from cross.sources import ZIG
from cross.targets import PYTHONS, Target

PACKAGE = ROOT / "native" / "binding" / "discrete_fairing"
WHEELS = native_build.BUILD / "wheels" / "cross"
METADATA = (
    "import sys, scikit_build_core.build as b; b.prepare_metadata_for_build_wheel(sys.argv[1])"
)


def stage(folder: Path) -> None:
    """Copies the package and its metadata, for any platform."""
    shutil.copytree(PACKAGE, folder / PACKAGE.name, ignore=shutil.ignore_patterns("__pycache__"))
    run(VENV_PYTHON, "-c", METADATA, folder, **{LOCAL_PART: local_version()})


def pack(staged: Path, module: Path, tag: str, folder: Path) -> Path:
    """Packs the staged files with the module of one Python and platform."""
    with tempfile.TemporaryDirectory() as place:
        made = Path(shutil.copytree(staged, Path(place) / "wheel"))
        shutil.copy(module, made / PACKAGE.name)
        (info,) = made.glob("*.dist-info/WHEEL")
        text = re.sub(r"(?m)^(Tag|Root-Is-Purelib): .*\n+", "", info.read_text()).rstrip()
        info.write_text(f"{text}\nRoot-Is-Purelib: false\nTag: {tag}\n")
        code, text = output(VENV_PYTHON, "-m", "wheel", "pack", made, "--dest-dir", place)
        if code:
            raise DevError(f"the wheel for {tag} cannot be packed: {text.strip()[-500:]}")
        return Path(shutil.copy(only_wheel(Path(place)), folder))


def inspect(wheels: list[Path]) -> None:
    """Raises an error for wheels that their tags' systems could not load."""
    tools = str(ROOT / "build_tools")
    code, text = output(VENV_PYTHON, "-m", "cross.inspection", *wheels, PYTHONPATH=tools)
    if code:
        raise DevError(text.strip())


def build(target: Target, pythons: tuple[str, ...] = PYTHONS) -> list[Path]:
    """The wheels of one platform, compiled and inspected; returns at once if nothing has changed."""
    with alone("cross"):
        folder, stamp = WHEELS / target.name, CACHE / f"cross-{target.name}.stamp"
        tools = files_under(ROOT / "build_tools" / "cross", ZIG)
        value = fingerprint(inputs() + tools, local_version(), *pythons)
        if not (is_fresh(stamp, value) and folder.is_dir()):
            say(f"cross compilation for {target.name}")
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            with tempfile.TemporaryDirectory() as staged:
                stage(Path(staged))
                for python in pythons:
                    tag = f"{python}-{python}-{target.wheel_tag}"
                    pack(Path(staged), native_build.module(target, python), tag, folder)
            inspect(sorted(folder.glob("*.whl")))
            leave(stamp, value)
        return sorted(folder.glob("*.whl"))
