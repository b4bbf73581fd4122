# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs jobs one after another on a thread, watched from the main thread. No Blender."""

import atexit
import os
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from threading import Thread, get_native_id
from typing import Any, Protocol, TextIO
from weakref import WeakSet

from .errors import JobCancelled, JobError

_PHASES = {
    "check": "Checking",
    "hierarchy": "Refining",
    "curves": "Drawing curves",
    "solve": "Fairing",
    "constrain": "Keeping the tolerance",
    "measure": "Measuring",
    "output": "Building the mesh",
    "patches": "Fitting patches",
    "done": "Done",
}
_NICENESS = 5  # added to the niceness of computing threads
_running = None  # the queue in progress
_started: "WeakSet[Queue]" = WeakSet()


class Runnable(Protocol):
    """A job of a queue: read on the main thread by its constructor, computed on any thread."""

    name: str  # for sentences

    @property
    def triangles(self) -> int:
        """Its size, for the progress bar."""

    def compute(self, **watchers: Any) -> None:
        """Runs the core with the `monitor` and `progress` in `watchers`; raises JobError."""


class Queue:
    """A sequence of jobs. Its thread runs only `compute`, and uses nothing of Blender."""

    def __init__(self, jobs: Sequence[Runnable], make_monitor: Callable[[], Any]) -> None:
        """`make_monitor()` returns a Monitor of the core, one for each job."""
        self.jobs = jobs
        self.error: str | None = None  # a sentence, if a job has failed
        self.cancelled = False
        self._monitors = [make_monitor() for _ in jobs]
        self._index = 0
        self._thread = Thread(target=self._run, name="discrete fairing", daemon=True)

    def start(self) -> None:
        _started.add(self)
        self._thread.start()

    @property
    def finished(self) -> bool:
        """Whether the thread has ended, successfully or not."""
        return not self._thread.is_alive()

    @property
    def fraction(self) -> float:
        """Share of the work done, 0 to 1; a job counts by its triangles."""
        total = sum(job.triangles for job in self.jobs)
        done = sum(job.triangles for job in self.jobs[: self._index])
        if self._index < len(self.jobs):
            done += self._monitors[self._index].fraction * self.jobs[self._index].triangles
        return done / total if total else 1.0

    @property
    def phase(self) -> str:
        """The core's name of the current phase."""
        return self._monitors[self._current].phase

    @property
    def job_name(self) -> str:
        return self.jobs[self._current].name

    @property
    def position(self) -> tuple[int, int]:
        """Number of the current job and number of jobs, such as `(2, 5)`."""
        return self._current + 1, len(self.jobs)

    def cancel(self) -> None:
        """Makes the thread end soon."""
        self.cancelled = True
        for monitor in self._monitors:
            monitor.cancel()

    def join(self) -> None:
        self._thread.join()

    @property
    def _current(self) -> int:
        return min(self._index, len(self.jobs) - 1)

    def _run(self) -> None:
        _let_the_window_go_first()
        try:
            for job, monitor in zip(self.jobs, self._monitors):
                job.compute(monitor=monitor)
                self._index += 1
        except JobCancelled:
            self.cancelled = True
        except JobError as error:
            self.error = str(error)
        except Exception as error:  # an error on a thread would be lost otherwise
            self.error = f"{self.job_name}: an unexpected error, please report it: {error!r}"


def _let_the_window_go_first() -> None:
    """Lowers the priority of this thread and of those that it starts; on Linux each has its own."""
    if sys.platform == "linux":
        with suppress(OSError):
            now = os.getpriority(os.PRIO_PROCESS, get_native_id())
            os.setpriority(os.PRIO_PROCESS, get_native_id(), now + _NICENESS)


@atexit.register
def end_all() -> None:
    """Cancels all queues and waits for their threads, before Blender quits or the add-on is disabled."""
    queues = [queue for queue in _started if not queue.finished]
    for queue in queues:
        queue.cancel()
    for queue in queues:
        queue.join()


def running() -> Queue | None:
    """The Queue in progress that keeps the operators busy, or None."""
    return _running


def set_running(queue: Queue | None) -> None:
    global _running
    _running = queue


def status_text(queue: Queue) -> str:
    """`Suzanne (2 of 5): Fairing, 45 %`."""
    position, count = queue.position
    which = f" ({position} of {count})" if count > 1 else ""
    return f"{queue.job_name}{which}: {progress_text(queue)}"


def progress_text(queue: Queue) -> str:
    """The progress, such as `Fairing, 45 %`."""
    doing = "Cancelling" if queue.cancelled else phase_text(queue.phase)
    return f"{doing}, {100 * queue.fraction:.0f} %"


def phase_text(phase: str) -> str:
    return _PHASES.get(phase, phase.capitalize())


class ConsoleProgress:
    """The core's `progress`: prints a line after every tenth of so many `runs`, which `end_run` counts."""

    def __init__(self, name: str, runs: int = 1, stream: TextIO | None = None) -> None:
        self._name, self._runs, self._stream = name, runs, stream or sys.stdout
        self._done, self._tenths = 0, -1

    def __call__(self, fraction: float, phase: str) -> None:
        tenths = int(10 * (self._done + fraction) / self._runs)
        if tenths > self._tenths:
            self._tenths = tenths
            text = f"{self._name}: {phase_text(phase)}, {10 * tenths} %"
            print(text, file=self._stream, flush=True)

    def end_run(self) -> None:
        self._done += 1
