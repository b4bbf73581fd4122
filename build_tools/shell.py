# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs other programs: prints each command, and reports a failure in one clear sentence."""

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from layout import ROOT, VENV_BIN


class DevError(Exception):
    """An error for the user of dev.py; shown without a traceback."""


def say(message: str) -> None:
    """Prints a progress line, in order with the output of programs."""
    print(f"» {message}", flush=True)


def environment(**extra: str) -> dict[str, str]:
    """This process's environment with the project's tools first on the path."""
    return {**os.environ, "PATH": f"{VENV_BIN}{os.pathsep}{os.environ['PATH']}", **extra}


def run(*command: str | Path, check: bool = True, **extra: str) -> int:
    """Runs a program in the project's folder; `extra` are environment variables."""
    words = [str(word) for word in command]
    print("$ " + shlex.join(words), flush=True)
    code = subprocess.run(words, cwd=ROOT, env=environment(**extra)).returncode
    if check and code != 0:
        raise DevError(f"`{words[0]}` failed with exit code {code}; its output is above.")
    return code


def output(*command: str | Path, **extra: str) -> tuple[int, str]:
    """Exit code and output (with errors) of a program that runs quietly; 127 if it is not installed."""
    words = [str(word) for word in command]
    if shutil.which(words[0], path=environment()["PATH"]) is None:
        return 127, ""
    done = subprocess.run(
        words,
        cwd=ROOT,
        env=environment(**extra),
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    return done.returncode, done.stdout


def as_root(*command: str | Path) -> list[str]:
    """The command line that runs `command` as root, by sudo if needed."""
    words = [str(word) for word in command]
    if os.geteuid() == 0:
        return words
    if shutil.which("sudo") is None:
        raise DevError(f"`{words[0]}` needs root: run dev.py as root, or install sudo.")
    return ["sudo", *words]


def fail(message: str) -> None:
    """Ends the process with a sentence."""
    print(f"dev.py: {message}", file=sys.stderr, flush=True)
    raise SystemExit(1)
