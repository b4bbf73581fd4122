# SPDX-License-Identifier: GPL-3.0-or-later
"""The command: runs one input after another and reports by text, JSON and exit code."""

import argparse
import os
import signal
import sys
import time
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any, TextIO

import bpy

from .. import core, memory
from ..blender import Object, current_context
from ..cad.fit import PatchJob
from ..errors import JobError, repairs_text
from ..job import Job
from ..scan_fit import Fit, FitJob
from ..settings import PatchOptions, Settings
from . import ease, executors, fit, mending, report, step
from .files import FileError, read_file, write_file, write_text
from .options import parser, settings_of, shown
from .places import BadPlaces, Place, is_cad, is_there, no_report_over, places
from .report import Progress

ALL_DONE, SOME_FAILED, WRONG_USAGE, NO_NATIVE_MODULE, INTERRUPTED = 0, 1, 2, 3, 130


def main(argv: list[str]) -> int:
    """Returns the exit code. `argv`: the arguments after the command's name."""
    try:
        arguments, settings, files = _understand(argv)
    except SystemExit as end:  # raised by argparse after --help, --version and errors
        return int(end.code or ALL_DONE)
    if core.why_missing():
        _say(core.why_missing())
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
        reported = arguments.mending.module.shown(arguments.mending.options)
    records = [report.new_record(file, reported) for file in files]
    table = _Table(arguments, files, records, settings.energy)
    spread = executors.is_spread(arguments)
    if why := table.why_no_log():
        _say(f"error: {why}")
        return records, SOME_FAILED
    try:
        with executors.executor(arguments) if spread else nullcontext() as executor:
            if executor is not None and arguments.pieces is None:
                _run_batches(executor, argv, records, table)
            else:
                arguments.spread = executor and executor.faired
                for index, file in enumerate(files):
                    _run_one(file, records[index], arguments, settings)
                    table.line(index)
    except executors.NoExecutor as error:
        _say(f"error: {error}")
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
        _say(f"{waiting[0]['input']}: interrupted")


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
            _say(report.table_head(self._width, module, energy))

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
            _say(report.table_line(record, self._width, module))


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
                _fail(record, "INTERNAL", (), f"{record['input']}: {found}")
                continue
            record.update(found[k])
            if record["error"] is not None:
                _say(f"error: {record['error']['message']}")
            for entry in record["objects"] if table.is_wanted else ():
                _say_mended(record["input"], entry["report"].get("repairs"))
                _say_eased(record["input"], entry)
            for warning in record["warnings"]:
                _say(f"{record['input']}: warning: {warning}")
            table.line(index)


def _say_mended(name: object, repairs: Any) -> None:
    mended = repairs_text(repairs) if repairs else ""
    if mended:
        _say(f"{name}: mended: {mended}")


def _say_eased(name: object, entry: dict[str, Any]) -> None:
    if "eased" in entry:
        _say(f"{name}: {entry['name']}: {entry['eased']['said']}")


def _run_one(
    file: Place, record: dict[str, Any], arguments: argparse.Namespace, settings: Settings
) -> None:
    """Fairs one file, and notes the outcome in its record."""
    start = time.perf_counter()
    try:
        for path in (file.target, arguments.tables.get(file)):
            if arguments.overwrite is False and path is not None and is_there(path):
                raise FileError("EXISTS", f"{path} exists, and is kept.")
        if arguments.mending is None:
            _fair_file(file, record, arguments, settings)
        else:
            _mend_file(file, record, arguments)
        record["status"] = report.DONE
    except (FileError, JobError) as error:
        _fail(
            record,
            *_code_and_elements(error),
            f"{file.source}: {error}" if isinstance(error, JobError) else str(error),
        )
    except Exception as error:  # an error in the add-on must not stop the other inputs
        traceback.print_exc()
        _fail(record, "INTERNAL", (), f"{file.source}: {type(error).__name__}: {error}")
    finally:
        record["seconds"] = round(time.perf_counter() - start, 3)


def _fair_file(
    file: Place, record: dict[str, Any], arguments: argparse.Namespace, settings: Settings
) -> None:
    near: Fit | None = None
    if arguments.drawn is None:
        sources = read_file(file.source, arguments.merge)
    else:
        sources, near = fit.read(file, arguments.drawn, arguments.merge)
    prepared = arguments.prepared
    ease.require_one(sources, prepared)
    progress = Progress(sys.stderr, str(file.source), len(sources) * (1 + prepared.runs))
    watchers: dict[str, Any] = {} if arguments.quiet else {"progress": progress}
    patches = arguments.patches if is_cad(file.target) else None
    is_read = not arguments.quiet or arguments.json is not None
    asked = {
        name: value
        for name in ("weld", "threads")
        if (value := getattr(arguments, name)) is not None
    }
    try:
        preparing = ease.Preparing(prepared, settings, asked)
        entries, tables = preparing.run(sources, progress.next_run, **watchers)
        jobs = [_job(source, settings, patches, near) for source in sources]
        for job in jobs:
            # the table and the report contain energies
            job.arguments |= asked | {"measure": is_read and patches is None}
            job.pieces, job.spread = arguments.pieces, arguments.spread
            job.compute(**watchers)
            progress.next_run()
    finally:
        progress.clear()
    if patches is not None:
        step.require_patches(jobs)
    for job, source, entry in zip(jobs, sources, entries):
        if not arguments.quiet:
            _say_mended(file.source, job.result.report["repairs"])
            _say_eased(file.source, entry | {"name": source.name})
        for warning in job.warnings():
            record["warnings"].append(warning)
            _say(f"{file.source}: warning: {warning}")
        if near is not None:
            entry["fit"] = fit.entry(job)
            if not arguments.quiet:
                _say(f"{file.source}: {fit.said(entry['fit'])}")
        is_patches = isinstance(job, PatchJob)
        done = step.object_entry(job) if is_patches else _replace(job, source)
        record["objects"].append(done | entry)
    if patches is None:
        write_file(file.target)
    else:
        step.write_step_file(file, jobs, patches)
    for found in tables:
        ease.write_table(arguments.tables[file], found)


def _mend_file(file: Place, record: dict[str, Any], arguments: argparse.Namespace) -> None:
    sources = read_file(file.source, arguments.merge)
    progress = Progress(sys.stderr, str(file.source), len(sources))
    watchers: dict[str, Any] = {} if arguments.quiet else {"progress": progress}
    if arguments.threads is not None:
        watchers["threads"] = arguments.threads
    warnings: list[str] = []
    try:
        for source in sources:
            entry, said = arguments.mending.module.run(
                source, arguments.mending.options, **watchers
            )
            record["objects"].append(entry)
            warnings += said
            progress.next_run()
    finally:
        progress.clear()
    for warning in warnings:
        record["warnings"].append(warning)
        _say(f"{file.source}: warning: {warning}")
    write_file(file.target)


def _job(source: Object, settings: Settings, patches: PatchOptions | None, near: Fit | None) -> Any:
    if patches is not None:
        return PatchJob(current_context(), source, patches, settings, near)
    if near is not None:
        return FitJob(current_context(), source, near, settings)
    return Job(current_context(), source, settings)


def _replace(job: Job, source: Object) -> dict[str, Any]:
    """Replaces a job's source by its result, under the same name. Returns the entry for the report."""
    entry: dict[str, Any] = {"name": source.name, "control": report.counts(source.data)}
    target = job.write(current_context())
    bpy.data.objects.remove(source)
    target.name = entry["name"]
    return entry | {"result": report.counts(target.data), "report": memory.recall(target, "report")}


def _code_and_elements(error: Any) -> tuple[str, Sequence[Any]]:
    """From the error itself, or from the core's error that caused it."""
    for part in (error, error.__cause__):
        if getattr(part, "code", None):
            return part.code, getattr(part, "elements", ())
    return "REFUSED", ()


def _fail(record: dict[str, Any], code: str, elements: Sequence[Any], message: str) -> None:
    record["status"] = report.FAILED
    record["error"] = report.error_entry(code, message, elements)
    record["objects"].clear()
    _say(f"error: {message}")


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
        _say(f"error: {error}")
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


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
