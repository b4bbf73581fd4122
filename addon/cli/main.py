# SPDX-License-Identifier: GPL-3.0-or-later
"""The command: runs one input after another and reports by text, JSON and exit code."""

import argparse
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any, TextIO

import bpy

from .. import core
from ..settings import Settings
from . import ease, executors, fit, mending, report, step
from .files import FileError, write_text
from .one_file import fail, run_one, say, say_eased, say_mended
from .options import parser, settings_of, shown
from .places import BadPlaces, Place, is_cad, no_report_over, places

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
    table = _Table(arguments, files, records, settings.energy)
    spread = executors.is_spread(arguments)
    if why := table.why_no_log():
        say(f"error: {why}")
        return records, SOME_FAILED
    try:
        with executors.executor(arguments) if spread else nullcontext() as executor:
            if executor is not None and arguments.pieces is None:
                _run_batches(executor, argv, records, table)
            else:
                arguments.spread = executor and executor.faired
                for index, file in enumerate(files):
                    run_one(file, records[index], arguments, settings)
                    table.line(index)
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


class _Table:
    """Prints a row for each finished input, unless the user has turned that off."""

    def __init__(
        self,
        arguments: argparse.Namespace,
        files: list[Place],
        records: list[dict[str, Any]],
        energy: str,
    ) -> None:
        self.is_wanted = not arguments.quiet
        meshes = report if arguments.drawn is None else fit
        self._of_meshes: Any = arguments.mending.module if arguments.mending else meshes
        self._files, self._records = files, records
        # processes of an executor leave this to the process that started them
        self._log = Path(arguments.log) if arguments.log and arguments.only is None else None
        self._width = max((len(record["input"]) for record in records), default=0)
        if self.is_wanted:
            module = self._of_meshes if arguments.patches is None else step
            say(report.table_head(self._width, module, energy))

    def why_no_log(self) -> str:
        """A sentence; empty if rows can be appended."""
        try:
            if self._log is not None:
                self._log.open("a").close()
        except OSError as error:
            return f"{self._log} cannot be written: {error.strerror}."
        return ""

    def line(self, index: int) -> None:
        record = self._records[index]
        if self._log is not None:
            with self._log.open("a", encoding="utf-8") as log:
                log.write(report.log_line(record))
        if record["status"] == report.DONE and self.is_wanted:
            is_step = is_cad(self._files[index].target)  # STEP files contain no mended mesh
            module = step if is_step else self._of_meshes
            say(report.table_line(record, self._width, module))


def _run_batches(
    executor: executors.TaskExecutor,
    argv: Sequence[str],
    records: list[dict[str, Any]],
    table: _Table,
) -> None:
    """Runs all files in parallel, and prints what this process would have printed for each."""
    for share, found in executors.run_files(executor, argv, len(records)):
        for k, index in enumerate(share):
            record = records[index]
            if isinstance(found, str):
                fail(record, "INTERNAL", (), f"{record['input']}: {found}")
                continue
            record.update(found[k])
            if record["error"] is not None:
                say(f"error: {record['error']['message']}")
            for entry in record["objects"] if table.is_wanted else ():
                say_mended(record["input"], entry["report"].get("repairs"))
                say_eased(record["input"], entry)
            for warning in record["warnings"]:
                say(f"{record['input']}: warning: {warning}")
            table.line(index)


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
