# SPDX-License-Identifier: GPL-3.0-or-later
"""The command: parses, runs one input after another, and says how it went by text, JSON and exit code."""

import json
import os
import signal
import sys
import time
import traceback
from contextlib import contextmanager

import bpy

from .. import native
from ..run.job import Job, JobError
from ..write.object import REPORT
from . import report
from .arguments import parser
from .files import FileError, read_file, write_file, write_text
from .options import settings_of, shown
from .places import BadPlaces, places
from .progress import Progress

ALL_DONE, SOME_FAILED, WRONG_USAGE, NO_NATIVE_MODULE, INTERRUPTED = 0, 1, 2, 3, 130


def main(argv):
    """The exit code. `argv`: what follows the command's name."""
    try:
        arguments, settings, ways = _understand(argv)
    except SystemExit as end:  # argparse's, after --help, --version and errors
        return end.code or ALL_DONE
    if native.why_missing():
        _say(native.why_missing())
        return NO_NATIVE_MODULE
    with _standard_output(arguments.json) as output, _interruptible():
        records, exit_code = _run_all(arguments, settings, ways)
        return _write_report(arguments.json, output, exit_code, records)


def _understand(argv):
    """Options, settings and places; leaves by SystemExit if there is nothing to run."""
    made = parser(" ".join(f"{name} {number}" for name, number in _versions().items()))
    arguments = made.parse_intermixed_args(argv)
    try:
        return arguments, settings_of(arguments), places(arguments.inputs, arguments.output, arguments.format)
    except (ValueError, BadPlaces) as error:
        made.error(str(error))


def _run_all(arguments, settings, ways):
    """Records of all inputs, also of those that an interruption left, and the exit code."""
    records = [report.new_record(way, shown(settings)) for way in ways]
    width = max(len(record["input"]) for record in records)
    if not arguments.quiet:
        _say(report.table_head(width, settings.energy))
    for way, record in zip(ways, records):
        try:
            _run_one(way, record, arguments, settings)
        except KeyboardInterrupt:
            record["status"] = report.CANCELLED
            record["error"] = report.error_entry("CANCELLED", "Interrupted.")
            _say(f"{way.source}: interrupted")
            return records, INTERRUPTED
        if record["status"] == report.DONE and not arguments.quiet:
            _say(report.table_line(record, width))
    failed = any(record["status"] == report.FAILED for record in records)
    return records, SOME_FAILED if failed else ALL_DONE


def _run_one(way, record, arguments, settings):
    """Fairs one file, and notes in its record how that went."""
    start = time.perf_counter()
    try:
        if arguments.overwrite is False and way.target.exists():
            raise FileError("EXISTS", f"{way.target} exists, and is kept.")
        _fair_file(way, record, arguments, settings)
        record["status"] = report.DONE
    except (FileError, JobError) as error:
        _fail(
            record,
            *_code_and_elements(error),
            f"{way.source}: {error}" if isinstance(error, JobError) else str(error),
        )
    except Exception as error:  # a fault of ours: the other inputs need not suffer
        traceback.print_exc()
        _fail(record, "INTERNAL", (), f"{way.source}: {type(error).__name__}: {error}")
    finally:
        record["seconds"] = round(time.perf_counter() - start, 3)


def _fair_file(way, record, arguments, settings):
    sources = read_file(way.source, arguments.merge)
    progress = Progress(sys.stderr, str(way.source), len(sources))
    jobs = [Job(bpy.context, source, settings) for source in sources]
    try:
        for job in jobs:
            if arguments.threads is not None:
                job.arguments["threads"] = arguments.threads
            job.compute(**{} if arguments.quiet else {"progress": progress})
            progress.next_run()
    finally:
        progress.clear()
    for job, source in zip(jobs, sources):
        record["objects"].append(_replace(job, source))
        for warning in job.warnings():
            record["warnings"].append(warning)
            _say(f"{way.source}: warning: {warning}")
    write_file(way.target)


def _replace(job, source):
    """Puts a job's result in the place of its source, under its name, and returns the entry for the report."""
    entry = {"name": source.name, "control": _counts(source.data)}
    target = job.write(bpy.context)
    bpy.data.objects.remove(source)
    target.name = entry["name"]
    return entry | {"result": _counts(target.data), "report": json.loads(target[REPORT])}


def _counts(mesh):
    return {"vertices": len(mesh.vertices), "faces": len(mesh.polygons)}


def _code_and_elements(error):
    """From the error itself, or from the core's below it."""
    for part in (error, error.__cause__):
        if getattr(part, "code", None):
            return part.code, getattr(part, "elements", ())
    return "REFUSED", ()


def _fail(record, code, elements, message):
    record["status"] = report.FAILED
    record["error"] = report.error_entry(code, message, elements)
    record["objects"].clear()
    _say(f"error: {message}")


def _write_report(where, output, exit_code, records):
    """The final exit code: a report that cannot be written is a failure too."""
    if not where:
        return exit_code
    text = report.document(_versions(), exit_code, records)
    if where == "-":
        output.write(text)
        output.flush()
        return exit_code
    try:
        write_text(where, text)
    except FileError as error:
        _say(f"error: {error}")
        return exit_code or SOME_FAILED
    return exit_code


def _versions():
    core = "none" if native.why_missing() else native.core().__version__
    return {"discrete_fairing": core, "blender": bpy.app.version_string}


@contextmanager
def _standard_output(where):
    """For `--json -` a stream to standard output that Blender's own messages do not reach.

    They go to standard error from now on, to the very end: the line that Blender writes at its start is still in a
    buffer if standard output is no terminal, and would come out after the report.
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
def _interruptible():
    """Ctrl-C as KeyboardInterrupt, which the core lets through; Blender would only take note of it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        if before is not None:  # None: Blender's own, which Python cannot name
            signal.signal(signal.SIGINT, before)


def _say(text):
    print(text, file=sys.stderr, flush=True)
