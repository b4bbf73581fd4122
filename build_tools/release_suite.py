# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests the extension's life at a user's in each real Blender: installed from a repository, used, updated, removed."""

import shutil
import zipfile
from pathlib import Path

import blender_repository
import extension
from blender_suite import SCRIPTS as BLENDER_SCRIPTS
from blender_suite import count, in_each
from layout import BUILD, ROOT
from real_blender import RealBlender
from serving import served
from shell import DevError, output, say
from stamp import alone
from tally import Tally
from wheel_version import manifest_version

SCRIPTS = ROOT / "tests" / "release"
SERVED = BUILD / "served"
REPOSITORY = "served"  # as Blender calls it in its settings
PACKAGE = "discrete_fairing"
PRESET = "scripts/presets/operator/object.fairing_surface/mine.py"


def next_version(version: str) -> str:
    """The version of the next bug-fix release."""
    rest, _, last = version.rpartition(".")
    return f"{rest}.{int(last) + 1}"


def newer(path: Path) -> Path:
    """The same zip as the next version: only its manifest differs."""
    old, new = manifest_version(), next_version(manifest_version())
    made = path.with_name(path.name.replace(old, new))
    with zipfile.ZipFile(path) as archive, zipfile.ZipFile(made, "w") as copy:
        for name in archive.namelist():
            data = archive.read(name)
            if name == "blender_manifest.toml":
                data = data.replace(f'version = "{old}"'.encode(), f'version = "{new}"'.encode())
            copy.writestr(name, data, zipfile.ZIP_DEFLATED)
    return made


def command(blender: RealBlender, *words: str) -> str:
    """The output of one of Blender's commands for extensions; its failure is an error."""
    code, text = output(*blender.headless("--online-mode", "--command", "extension", *words))
    told = "\n".join(line for line in text.splitlines() if not line.startswith("PROGRESS"))
    print(told, flush=True)
    if code:
        raise DevError(f"`extension {words[0]}` failed in Blender {blender.version}: {told[-300:]}")
    return told


def look(blender: RealBlender, stage: str, version: str) -> Tally:
    """Runs the script of one stage in this Blender."""
    say(f"Blender {blender.version}: {stage}")
    script = blender.seen(blender.exchange / "tests" / f"{stage}.py")
    facts = {"DF_VERSION": version, "DF_EXTENSION": f"bl_ext.{REPOSITORY}.{PACKAGE}"}
    words = ["--python-exit-code", "1", "--python", script]
    code, text = output(*blender.headless(*words, **facts))
    print(text, flush=True)
    return count(code, text, f"{stage}.py")


def check(name: str, fine: bool) -> Tally:
    """One test that is made outside Blender."""
    print(f"{'PASS' if fine else 'FAIL'} {name}", flush=True)
    return Tally(passed=int(fine), failed=int(not fine))


def traces(user: Path) -> list[str]:
    """Files of the extension in Blender's folder for a user, without those that the user made."""
    paths = (str(path.relative_to(user)) for path in user.rglob(f"*{PACKAGE}*"))
    return sorted(path for path in paths if not path.endswith(".pyc"))


def live(blender: RealBlender) -> Tally:
    """Runs all stages in one Blender."""
    blender.clear()
    (folder := SERVED / blender.version).mkdir(parents=True, exist_ok=True)
    zipped = extension.build([blender.root.wheel()], blender)
    tests = blender.exchange / "tests"
    shutil.copytree(SCRIPTS, tests, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(BLENDER_SCRIPTS / "harness.py", tests)
    user, now = blender.folder / blender.user, manifest_version()
    then = next_version(now)
    with served(folder) as address:
        blender_repository.generate(blender, [zipped], folder)
        # Blender's own repository is on the network, which tests do not use
        words = ["--clear-all", "--name", REPOSITORY, "--url", f"{address}/index.json", REPOSITORY]
        command(blender, "repo-add", *words)
        command(blender, "install", "--sync", "--enable", PACKAGE)
        total = look(blender, "installed", now)
        blender_repository.generate(blender, [newer(zipped)], folder)
        offered = f"outdated: {now} -> {then}" in command(blender, "list", "--sync")
        total += check("an update is offered", offered)
        command(blender, "update", "--sync")
        total += look(blender, "updated", then)
        total += check("presets are kept", (user / PRESET).is_file())
        command(blender, "remove", PACKAGE)
        total += look(blender, "removed", then)
        total += check("presets stay the user's", (user / PRESET).is_file())
        left = traces(user)
        print("\n".join(left), flush=True)
        total += check("no traces are left", not left)
    return total


def run_suite() -> dict[str, Tally]:
    """The tallies by Blender, one after the other."""
    with alone("blender"):
        return in_each(live, workers=1)
