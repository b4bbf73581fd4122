# SPDX-License-Identifier: GPL-3.0-or-later
"""The command: runs one file, and reports by text and exit code."""

import argparse
import signal
import traceback
from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from .. import core
from ..errors import JobError
from ..settings import Settings
from . import clean, fit, step
from .files import FileError
from .one_file import run_file, say
from .options import parser, settings_of
from .places import check_places

DONE, FAILED, WRONG_USAGE, NO_NATIVE_MODULE, INTERRUPTED = 0, 1, 2, 3, 130


def main(argv: list[str]) -> int:
    """Returns the exit code. `argv`: the arguments after the command's name."""
    try:
        arguments, settings = _understand(argv)
    except SystemExit as end:  # raised by argparse after --help, --version and errors
        return int(end.code or DONE)
    if core.why_missing():
        say(core.why_missing())
        return NO_NATIVE_MODULE
    with _interruptible():
        return _run(arguments, settings)


def _understand(argv: list[str]) -> tuple[argparse.Namespace, Settings]:
    """Options and settings; raises SystemExit if there is nothing to run."""
    made = parser(" ".join(f"{name} {number}" for name, number in _versions().items()))
    arguments = made.parse_intermixed_args(argv)
    try:
        settings = settings_of(arguments)
        check_places(arguments.input, arguments.output)
        arguments.patches = step.options_of(arguments, settings)
        arguments.cleaning = clean.options_of(arguments)
        fit.check(arguments, settings)
        return arguments, settings
    except ValueError as error:
        made.error(str(error))


def _run(arguments: argparse.Namespace, settings: Settings) -> int:
    try:
        run_file(arguments, settings)
    except KeyboardInterrupt:
        say(f"{arguments.input}: interrupted")
        return INTERRUPTED
    except FileError as error:
        say(f"error: {error}")
    except JobError as error:
        say(f"error: {arguments.input}: {error}")
    except Exception:  # Blender would ignore it
        traceback.print_exc()
    else:
        return DONE
    return FAILED


def _versions() -> dict[str, str]:
    version = "none" if core.why_missing() else core.module().__version__
    return {"discrete_fairing": version, "blender": bpy.app.version_string}


@contextmanager
def _interruptible() -> Iterator[None]:
    """Lets Ctrl-C raise KeyboardInterrupt, which the core passes on; Blender would only set a flag."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        if before is not None:  # None: Blender's own handler, which Python cannot restore
            signal.signal(signal.SIGINT, before)
