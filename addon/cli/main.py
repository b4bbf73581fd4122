# SPDX-License-Identifier: GPL-3.0-or-later
"""The command: fairs or cleans the meshes of one file, writes them, and reports by text and exit code."""

import argparse
import signal
import sys
import time
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import bpy

from .. import core
from ..blender import Object, current_context
from ..cad import words
from ..cad.fit import PatchJob, refused
from ..cad.step import summary, write_jobs
from ..errors import JobError, repairs_text
from ..jobs.clean import CleanJob
from ..jobs.fair import Job
from ..jobs.fit import Fit, FitJob
from ..queue import ConsoleProgress
from ..settings import PatchOptions, Settings
from . import clean, fit
from .files import FileError, read_file, write_file, write_whole
from .options import parser, patch_options_of, settings_of
from .places import check_places


class _Told:
    """Writes notes, unless they are to be left out, and warnings."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self._name, self._quiet = str(arguments.input), arguments.quiet

    def note(self, text: str) -> None:
        if not self._quiet:
            say(f"{self._name}: {text}")

    def warn(self, text: str) -> None:
        say(f"{self._name}: warning: {text}")

    def compute(self, jobs: Sequence[Any], **watchers: Any) -> None:
        """Computes the jobs, one a mesh, and writes their progress."""
        progress = ConsoleProgress(self._name, len(jobs), sys.stderr)
        for job in jobs:
            job.compute(**watchers | ({} if self._quiet else {"progress": progress}))
            progress.end_run()


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
    for job in jobs:
        job.arguments |= asked
    told.compute(jobs)
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
    before, context = _faces(sources), current_context()
    jobs = [CleanJob(context, source, arguments.cleaning) for source in sources]
    told.compute(jobs, **({} if arguments.threads is None else {"threads": arguments.threads}))
    for job in jobs:
        *done, end = job.apply(context)
        for sentence in done:
            told.note(f"{job.name}: {sentence}.")
        is_clean = job.result.watertight and not job.result.left
        (told.note if is_clean else told.warn)(f"{job.name}: {end}.")
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
        arguments.patches = patch_options_of(arguments, settings)
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
