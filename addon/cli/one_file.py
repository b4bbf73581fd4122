# SPDX-License-Identifier: GPL-3.0-or-later
"""The file of a call: fairs or cleans its meshes, writes them, and says how it went."""

import argparse
import sys
import time
from collections.abc import Sequence
from typing import Any

import bpy

from ..blender import Object, current_context
from ..cad import words
from ..cad.fit import PatchJob, refused
from ..cad.step import summary, write_jobs
from ..errors import JobError, repairs_text
from ..jobs.fair import Job
from ..jobs.fit import Fit, FitJob
from ..queue import ConsoleProgress
from ..settings import PatchOptions, Settings
from . import clean, fit
from .files import read_file, write_file, write_whole


class _Told:
    """Writes notes, unless they are to be left out, and warnings."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self._name, self._quiet = str(arguments.input), arguments.quiet

    def note(self, text: str) -> None:
        if not self._quiet:
            say(f"{self._name}: {text}")

    def warn(self, text: str) -> None:
        say(f"{self._name}: warning: {text}")

    def progress(self, count: int) -> ConsoleProgress | None:
        """The progress of so many meshes."""
        return None if self._quiet else ConsoleProgress(self._name, count, sys.stderr)


def run_file(arguments: argparse.Namespace, settings: Settings) -> None:
    """Runs the call, and writes its output; raises FileError and JobError."""
    begin, told = time.perf_counter(), _Told(arguments)
    work = _fair if arguments.cleaning is None else _clean
    before, after = work(arguments, settings, told)
    told.note(f"{before:,} faces → {after} in {time.perf_counter() - begin:.2f} s")


def _fair(arguments: argparse.Namespace, settings: Settings, told: _Told) -> tuple[int, str]:
    near: Fit | None = None
    if arguments.fit:
        sources, near = fit.read(arguments, settings)
    else:
        sources = read_file(arguments.input)
    patches = arguments.patches
    asked = {name: value for name in ("weld", "threads") if (value := getattr(arguments, name)) is not None}  # fmt: skip
    jobs = [_job(source, settings, patches, near) for source in sources]
    before = sum(len(job.arrays.face_sizes) for job in jobs)
    progress = told.progress(len(jobs))
    for job in jobs:
        job.arguments |= asked
        job.compute(**({} if progress is None else {"progress": progress}))
        if progress is not None:
            progress.end_run()
    _require_patches(jobs)
    for job in jobs:
        if mended := repairs_text(job.result.report["repairs"]):
            told.note(f"mended: {mended}")
        if isinstance(job, FitJob):  # `summary` says the same of patches
            told.note(job.said())
        for warning in job.warnings():
            told.warn(warning)
    if patches is not None:
        write_whole(arguments.output, lambda path: write_jobs(path, jobs, patches.unit, 1.0))
        told.note(summary(jobs, patches.unit, 1.0))
        return before, f"{sum(len(job.patches) for job in jobs):,} patches"
    after = sum(_replace(job, source) for job, source in zip(jobs, sources, strict=True))
    write_file(arguments.output)
    return before, f"{after:,} faces"


def _clean(arguments: argparse.Namespace, _settings: Settings, told: _Told) -> tuple[int, str]:
    sources = read_file(arguments.input)
    before = _faces(sources)
    progress = told.progress(len(sources))
    watchers: dict[str, Any] = {} if progress is None else {"progress": progress}
    if arguments.threads is not None:
        watchers["threads"] = arguments.threads
    for source in sources:
        said, is_clean = clean.run(source, arguments.cleaning, **watchers)
        for sentence in said if is_clean else said[:-1]:
            told.note(f"{source.name}: {sentence}.")
        if not is_clean:
            told.warn(f"{source.name}: {said[-1]}.")
        if progress is not None:
            progress.end_run()
    write_file(arguments.output)
    return before, f"{_faces(sources):,} faces"


def _faces(sources: Sequence[Object]) -> int:
    return sum(len(source.data.polygons) for source in sources)


def _require_patches(jobs: Sequence[Any]) -> None:
    faulty = refused([job for job in jobs if isinstance(job, PatchJob)])
    if faulty:
        raise JobError(
            words.together(job.warnings()[0] for job in faulty) + " --force writes them red."
        )


def _job(source: Object, settings: Settings, patches: PatchOptions | None, near: Fit | None) -> Any:
    if patches is not None:
        return PatchJob(current_context(), source, patches, settings, near)
    if near is not None:
        return FitJob(current_context(), source, near, settings)
    return Job(current_context(), source, settings)


def _replace(job: Job, source: Object) -> int:
    """Replaces a job's source by its result, under the same name. Returns its number of faces."""
    name = source.name
    target = job.write(current_context())
    bpy.data.objects.remove(source)
    target.name = name
    return len(target.data.polygons)


def say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
