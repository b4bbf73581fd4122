# SPDX-License-Identifier: GPL-3.0-or-later
"""One input of a call: fairs or mends its meshes, writes them, and notes the outcome in its record."""

import argparse
import sys
import time
import traceback
from collections.abc import Sequence
from typing import Any

import bpy

from .. import memory
from ..blender import Object, current_context
from ..cad.fit import PatchJob
from ..cad.step import summary, write_jobs
from ..errors import JobError, repairs_text
from ..job import Job
from ..queue import ConsoleProgress
from ..scan_fit import Fit, FitJob
from ..settings import PatchOptions, Settings
from . import fit, report, step
from .files import FileError, read_file, write_file, write_whole
from .places import Place, is_cad, is_there


def run_one(
    file: Place, record: dict[str, Any], arguments: argparse.Namespace, settings: Settings
) -> None:
    """Fairs one file, and notes the outcome in its record."""
    start = time.perf_counter()
    try:
        if arguments.overwrite is False and is_there(file.target):
            raise FileError("EXISTS", f"{file.target} exists, and is kept.")
        if arguments.mending is None:
            _fair_file(file, record, arguments, settings)
        else:
            _mend_file(file, record, arguments)
        record["status"] = report.DONE
    except (FileError, JobError) as error:
        fail(
            record,
            *_code_and_elements(error),
            f"{file.source}: {error}" if isinstance(error, JobError) else str(error),
        )
    except Exception as error:  # an error in the add-on must not stop the other inputs
        traceback.print_exc()
        fail(record, "INTERNAL", (), f"{file.source}: {type(error).__name__}: {error}")
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
    progress = ConsoleProgress(str(file.source), len(sources), sys.stderr)
    watchers: dict[str, Any] = {} if arguments.quiet else {"progress": progress}
    patches = arguments.patches if is_cad(file.target) else None
    asked = {
        name: value
        for name in ("weld", "threads")
        if (value := getattr(arguments, name)) is not None
    }
    jobs = [_job(source, settings, patches, near) for source in sources]
    for job in jobs:
        # the report contains energies
        job.arguments |= asked | {"measure": arguments.json is not None and patches is None}
        job.compute(**watchers)
        progress.end_run()
    if patches is not None:
        step.require_patches(jobs)
    for job, source in zip(jobs, sources):
        if mended := repairs_text(job.result.report["repairs"]):
            record["notes"].append(f"mended: {mended}")
        record["warnings"] += job.warnings()
        done = step.object_entry(job) if isinstance(job, PatchJob) else _replace(job, source)
        if near is not None:
            done["fit"] = fit.entry(job)
            if patches is None:  # `summary` says the same of patches
                record["notes"].append(fit.said(done["fit"]))
        record["objects"].append(done)
    if patches is None:
        write_file(file.target)
    else:
        write_whole(file.target, lambda path: write_jobs(path, jobs, patches.unit, 1.0))
        record["notes"].append(summary(jobs, patches.unit, 1.0))


def _mend_file(file: Place, record: dict[str, Any], arguments: argparse.Namespace) -> None:
    sources = read_file(file.source, arguments.merge)
    progress = ConsoleProgress(str(file.source), len(sources), sys.stderr)
    watchers: dict[str, Any] = {} if arguments.quiet else {"progress": progress}
    if arguments.threads is not None:
        watchers["threads"] = arguments.threads
    for source in sources:
        entry, warnings = arguments.mending.module.run(
            source, arguments.mending.options, **watchers
        )
        record["objects"].append(entry)
        record["warnings"] += warnings
        progress.end_run()
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


def fail(record: dict[str, Any], code: str, elements: Sequence[Any], message: str) -> None:
    record["status"] = report.FAILED
    record["error"] = report.error_entry(code, message, elements)
    record["objects"].clear()


def tell(record: dict[str, Any], quiet: bool) -> None:
    """Prints the outcome of an input; with `quiet` only what went wrong."""
    if record["error"] is not None:
        say(f"error: {record['error']['message']}")
    notes = [f"warning: {warning}" for warning in record["warnings"]]
    if not quiet:
        notes = [*record["notes"], *notes]
    for note in notes:
        say(f"{record['input']}: {note}")
    if record["status"] == report.DONE and not quiet:
        say(report.line(record))


def say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
