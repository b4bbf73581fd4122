# SPDX-License-Identifier: GPL-3.0-or-later
"""The command: runs one input after another and reports by text, JSON and exit code."""

import argparse
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from typing import Any, TextIO

import bpy

from .. import core
from ..settings import Settings
from . import ease, executors, fit, mending, report, step
from .files import FileError, write_text
from .one_file import fail, run_one, say, tell
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
        records, exit_code = _run_all(arguments, settings, files, argv)
        return _write_report(arguments.json, output, exit_code, records)


def _understand(argv: list[str]) -> tuple[argparse.Namespace, Settings, list[Place]]:
    """Options, settings and places; raises SystemExit if there is nothing to run."""
    made = parser(" ".join(f"{name} {number}" for name, number in _versions().items()))
    arguments = made.parse_intermixed_args(argv)
    try:
        settings = settings_of(arguments)
        files = places(arguments.inputs, arguments.output, arguments.format)
        arguments.prepared = ease.options_of(arguments, files)
        arguments.tables = dict(zip(files, arguments.prepared.tables or ()))
        files = files[arguments.only] if arguments.only else files
        if arguments.scheduler is not None and arguments.jobs > 1:
            raise ValueError("give one of --jobs and --scheduler: a cluster has workers of its own")
        no_report_over(arguments.json, files)
        arguments.patches = step.options_of(arguments, settings, files)
        arguments.mending = mending.asked_of(arguments, files)
        arguments.drawn = fit.options_of(arguments, settings)
        return arguments, settings, files
    except (ValueError, BadPlaces) as error:
        made.error(str(error))


def _run_all(
    arguments: argparse.Namespace,
    settings: Settings,
    files: list[Place],
    argv: Sequence[str],
) -> tuple[list[dict[str, Any]], int]:
    """Records of all inputs, including those not reached after an interruption, and the exit code."""
    reported = shown(settings) | ease.shown(arguments.prepared) | fit.shown(arguments.drawn)
    if arguments.mending is not None:
        reported = arguments.mending.said
    records = [report.new_record(file, reported) for file in files]
    spread = executors.is_spread(arguments)
    try:
        with executors.executor(arguments) if spread else nullcontext() as executor:
            if executor is not None and arguments.pieces is None:
                _run_batches(executor, argv, records, arguments.quiet)
            else:
                arguments.spread = executor and executor.faired
                for index, file in enumerate(files):
                    run_one(file, records[index], arguments, settings)
                    tell(records[index], arguments.quiet)
    except executors.NoExecutor as error:
        say(f"error: {error}")
        return records, SOME_FAILED
    except KeyboardInterrupt:
        _note_interruption(records, all_of_them=spread and arguments.pieces is None)
        return records, INTERRUPTED
    failed = any(record["status"] == report.FAILED for record in records)
    return records, SOME_FAILED if failed else ALL_DONE


def _note_interruption(records: list[dict[str, Any]], all_of_them: bool) -> None:
    """Notes an interruption in the record of the current input, or of `all_of_them`."""
    waiting = [record for record in records if record["status"] == report.NOT_RUN]
    for record in waiting if all_of_them else waiting[:1]:
        record["status"] = report.CANCELLED
        record["error"] = report.error_entry("CANCELLED", "Interrupted.")
    if waiting:
        say(f"{waiting[0]['input']}: interrupted")


def _run_batches(
    executor: executors.TaskExecutor,
    argv: Sequence[str],
    records: list[dict[str, Any]],
    quiet: bool,
) -> None:
    """Runs all files in parallel."""
    for share, found in executors.run_files(executor, argv, len(records)):
        for k, index in enumerate(share):
            record = records[index]
            if isinstance(found, str):
                fail(record, "INTERNAL", (), f"{record['input']}: {found}")
            else:
                record.update(found[k])
            tell(record, quiet)


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
