# SPDX-License-Identifier: GPL-3.0-or-later
"""The command: runs one input after another and reports by text, JSON and exit code."""

import argparse
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO

import bpy

from .. import core
from ..settings import Settings
from . import fit, mending, report, step
from .files import FileError, write_text
from .one_file import run_one, say, tell
from .options import parser, settings_of, shown
from .places import BadPlaces, Place, no_report_over, places

ALL_DONE, SOME_FAILED, WRONG_USAGE, NO_NATIVE_MODULE, INTERRUPTED = 0, 1, 2, 3, 130


def main(argv: list[str]) -> int:
    """Returns the exit code. `argv`: the arguments after the command's name."""
    try:
        arguments, settings, files = _understand(argv)
    except SystemExit as end:  # raised by argparse after --help, --version and errors
        return int(end.code or ALL_DONE)
    if core.why_missing():
        say(core.why_missing())
        return NO_NATIVE_MODULE
    with _standard_output(arguments.json) as output, _interruptible():
        records, exit_code = _run_all(arguments, settings, files)
        return _write_report(arguments.json, output, exit_code, records)


def _understand(argv: list[str]) -> tuple[argparse.Namespace, Settings, list[Place]]:
    """Options, settings and places; raises SystemExit if there is nothing to run."""
    made = parser(" ".join(f"{name} {number}" for name, number in _versions().items()))
    arguments = made.parse_intermixed_args(argv)
    try:
        settings = settings_of(arguments)
        files = places(arguments.inputs, arguments.output, arguments.format)
        no_report_over(arguments.json, files)
        arguments.patches = step.options_of(arguments, settings, files)
        arguments.mending = mending.asked_of(arguments, files)
        arguments.drawn = fit.options_of(arguments, settings)
        return arguments, settings, files
    except (ValueError, BadPlaces) as error:
        made.error(str(error))


def _run_all(
    arguments: argparse.Namespace, settings: Settings, files: list[Place]
) -> tuple[list[dict[str, Any]], int]:
    """Records of all inputs, including those not reached after an interruption, and the exit code."""
    reported = shown(settings) | fit.shown(arguments.drawn)
    if arguments.mending is not None:
        reported = arguments.mending.said
    records = [report.new_record(file, reported) for file in files]
    for file, record in zip(files, records):
        try:
            run_one(file, record, arguments, settings)
        except KeyboardInterrupt:
            record["status"] = report.CANCELLED
            record["error"] = report.error_entry("CANCELLED", "Interrupted.")
            say(f"{record['input']}: interrupted")
            return records, INTERRUPTED
        tell(record, arguments.quiet)
    failed = any(record["status"] == report.FAILED for record in records)
    return records, SOME_FAILED if failed else ALL_DONE


def _write_report(
    where: str | None, output: TextIO | None, exit_code: int, records: list[dict[str, Any]]
) -> int:
    """Writes the report and returns the final exit code: failing to write it is a failure too."""
    if not where:
        return exit_code
    text = report.document(_versions(), exit_code, records)
    if output is not None:
        output.write(text)
        output.flush()
        return exit_code
    try:
        write_text(where, text)
    except FileError as error:
        say(f"error: {error}")
        return exit_code or SOME_FAILED
    return exit_code


def _versions() -> dict[str, str]:
    version = "none" if core.why_missing() else core.module().__version__
    return {"discrete_fairing": version, "blender": bpy.app.version_string}


@contextmanager
def _standard_output(where: str | None) -> Iterator[TextIO | None]:
    """For `--json -`: a stream to standard output without Blender's own messages.

    They are redirected to standard error until the process ends: if standard output is no terminal,
    Blender's first line is still in a buffer, and would appear after the report.
    """
    if where != "-":
        yield None
        return
    sys.stdout.flush()
    own = os.dup(1)
    os.dup2(2, 1)
    with os.fdopen(own, "w", encoding="utf-8") as stream:
        yield stream


@contextmanager
def _interruptible() -> Iterator[None]:
    """Lets Ctrl-C raise KeyboardInterrupt, which the core passes on; Blender would only set a flag."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        if before is not None:  # None: Blender's own handler, which Python cannot restore
            signal.signal(signal.SIGINT, before)
