# SPDX-License-Identifier: GPL-3.0-or-later
"""Executes a call's work in this process, in several processes of this machine, or on a Dask cluster.

With --pieces the pieces of a mesh are distributed, otherwise the files: each task is this command
again, for some of its inputs.
"""

import json
import multiprocessing
import os
import subprocess
import sys
from argparse import Namespace
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures import as_completed as completed
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from operator import methodcaller
from pathlib import Path
from typing import Any

import bpy

_MORE_TRIES = 3  # for a task whose worker died
# Inputs of a task: starting Blender takes a second, and an interruption loses one task.
_MOST_FILES = 16
_TASKS_A_WORKER = 4  # so that no worker waits long for the last one
_LAST_WORDS = 2000  # characters of the output of a process that left no report


class NoExecutor(Exception):
    """Why there is no executor, as a sentence."""


# A worker of a cluster calls subprocess.run itself: it needs Blender and this extension, but no other
# code of ours.
@dataclass(frozen=True)
class TaskExecutor:
    """Runs tasks. `run_words`: like subprocess.run, for a command on a worker."""

    executor: Executor
    workers: int  # simultaneous tasks
    threads: int  # threads of each task
    run_words: Callable[..., Any] = subprocess.run

    def faired(self, pieces: Sequence[Any], memory_limit: int) -> Iterator[Any]:
        """The parts of the pieces, in order. `memory_limit`: bytes, for each piece."""
        fair = methodcaller("fair", threads=self.threads, memory_limit=memory_limit)
        return self.executor.map(fair, pieces)


def is_spread(arguments: Namespace) -> bool:
    """Whether work is distributed to other processes."""
    is_share = arguments.only is not None
    return not is_share and (arguments.scheduler is not None or arguments.jobs > 1)


@contextmanager
def executor(arguments: Namespace) -> Iterator[TaskExecutor]:
    """The requested executor. After an error running tasks are ended, and others not started."""
    with _dask(arguments) if arguments.scheduler else _local(arguments) as found:
        try:
            yield found
        except BaseException:
            found.executor.shutdown(wait=False, cancel_futures=True)
            for child in multiprocessing.active_children():
                child.terminate()
            raise


@contextmanager
def _local(arguments: Namespace) -> Iterator[TaskExecutor]:
    count = arguments.jobs
    if arguments.pieces is not None:
        spawn = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(count, mp_context=spawn) as pool:
            yield TaskExecutor(pool, count, _threads(arguments))
        return
    running: set[subprocess.Popen] = set()
    with ThreadPoolExecutor(count) as pool:  # each thread waits for its own process
        try:
            yield TaskExecutor(
                pool, count, _threads(arguments), lambda *a, **k: _run(running, *a, **k)
            )
        finally:
            for process in list(running):
                process.terminate()


def _run(
    running: set[subprocess.Popen], words: Sequence[str], *, capture_output: bool, **how: Any
) -> subprocess.CompletedProcess:
    """Like subprocess.run, and lists the process among the running ones."""
    pipe = subprocess.PIPE if capture_output else None
    with subprocess.Popen(words, stdout=pipe, stderr=pipe, **how) as process:
        running.add(process)
        try:
            output, said = process.communicate()
        finally:
            running.discard(process)
    return subprocess.CompletedProcess(words, process.returncode, output, said)


@contextmanager
def _dask(arguments: Namespace) -> Iterator[TaskExecutor]:
    address = arguments.scheduler
    if not bpy.app.online_access:
        raise NoExecutor(
            "--scheduler needs Blender's online access: allow it in Preferences > System > Network, "
            "or start Blender with --online-mode before --command."
        )
    try:
        import distributed
    except ImportError as error:
        raise NoExecutor(
            f"--scheduler needs the package distributed in Blender's own Python ({error})."
        ) from error
    try:
        client: Any = distributed.Client(address, timeout="10s")  # type: ignore[no-untyped-call]
    except (OSError, TimeoutError, ValueError) as error:
        raise NoExecutor(f"No Dask scheduler answers at {address} ({error}).") from error
    with client:
        workers = sum(client.nthreads().values())
        if not workers:
            raise NoExecutor(f"The Dask scheduler at {address} has no workers.")
        with client.get_executor(retries=_MORE_TRIES, pure=False) as executor:
            yield TaskExecutor(executor, workers, _threads(arguments))


def _threads(arguments: Namespace) -> int:
    """Threads of a task if the user has not set them: all tasks together use each core once."""
    if arguments.threads is not None:
        return arguments.threads
    return 1 if arguments.scheduler else max(1, (os.cpu_count() or 1) // arguments.jobs)


def batches(count: int, workers: int) -> list[range]:
    size = min(_MOST_FILES, max(1, count // (_TASKS_A_WORKER * workers)))
    return [range(first, min(first + size, count)) for first in range(0, count, size)]


def blender_again() -> list[str]:
    """The command line that starts this command again, without its arguments."""
    after = sys.argv.index("--command") if "--command" in sys.argv else len(sys.argv)
    flags = sys.argv[1:after] if "--background" in sys.argv[1:after] else ["--background"]
    return [bpy.app.binary_path, *flags, "--command", "discrete_fairing"]


def run_files(
    made: TaskExecutor, words: Sequence[str], count: int
) -> Iterator[tuple[range, list[dict[str, Any]] | str]]:
    """Runs this command, given as `words`, for all of `count` inputs, distributed over tasks.

    As tasks end, yields the inputs' numbers, and their records or, if a process left none, its output.
    Files are read and written by the worker, relative to the folder of this process.
    """
    tasks: dict[Future, range] = {}
    for share in batches(count, made.workers):
        own = [
            *blender_again(),
            *words,
            *("--threads", str(made.threads)),
            *("--only", f"{share.start}:{share.stop}"),
            *("--json", "-", "--quiet"),
        ]
        task = made.executor.submit(
            made.run_words, own, capture_output=True, cwd=Path.cwd(), stdin=subprocess.DEVNULL
        )
        tasks[task] = share
    for task in completed(tasks):
        yield tasks[task], _records(task, len(tasks[task]))


def _records(task: Future, count: int) -> list[dict[str, Any]] | str:
    try:
        done = task.result()
    except (
        Exception
    ) as error:  # an error of the executor: no such program there, or a worker that dies each time
        return f"{type(error).__name__}: {error}"
    found: list[dict[str, Any]] = []
    with suppress(ValueError, KeyError):
        found = json.loads(done.stdout)["inputs"]
    if len(found) == count:
        return found
    said = done.stderr.decode(errors="replace").strip()[-_LAST_WORDS:]
    return f"A process ended with code {done.returncode}: {said}"
