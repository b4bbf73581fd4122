# SPDX-License-Identifier: GPL-3.0-or-later
"""Jobs one after another on a thread of their own, watched from the main thread. No Blender."""

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
_NICENESS = 5  # of the threads that compute, above that of the window's
_running = None  # the queue in progress
_started: "WeakSet[Queue]" = WeakSet()


class Runnable(Protocol):
    """What a queue runs: read on the main thread when it is made, computed on any."""

    name: str  # what sentences call it

    @property
    def triangles(self) -> int:
        """How large it is, for the bar."""

    def compute(self, **watchers: Any) -> None:
        """Runs the core, whose `monitor` and `progress` the `watchers` are; raises JobError."""


class TimedJob(Runnable, Protocol):
    """One for an object of the user, who may wait for it."""

    result: Any  # what was computed; None before

    @property
    def predicted_seconds(self) -> float:
        """How long `compute` will take."""


class MeshJob(TimedJob, Protocol):
    """One that changes a mesh which others may have changed meanwhile."""

    def why_outdated(self, context: Any) -> str:
        """Why what was computed does not fit any more, in one sentence; empty if it does."""


class Queue:
    """A row of jobs. Nothing of Blender is touched on the thread: all that it runs is `compute`."""

    def __init__(self, jobs: Sequence[Runnable], make_monitor: Callable[[], Any]) -> None:
        """`make_monitor()` gives the core's Monitor, one a job."""
        self.jobs = jobs
        self.error: str | None = None  # a sentence, once a job has failed
        self.cancelled = False
        self._monitors = [make_monitor() for _ in jobs]
        self._index = 0
        self._thread = Thread(target=self._run, name="discrete fairing", daemon=True)

    def start(self) -> None:
        _started.add(self)
        self._thread.start()

    @property
    def finished(self) -> bool:
        """Whether the thread has ended, by success or not."""
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
        """The core's name of what it is doing."""
        return self._monitors[self._current].phase

    @property
    def job_name(self) -> str:
        return self.jobs[self._current].name

    @property
    def position(self) -> tuple[int, int]:
        """`(2, 5)`: the second of five."""
        return self._current + 1, len(self.jobs)

    def cancel(self) -> None:
        """Makes the thread end soon."""
        self.cancelled = True
        for monitor in self._monitors:
            monitor.cancel()

    def join(self) -> None:
        """Waits for the thread's end."""
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
        except Exception as error:  # an error on a thread would be lost without a word
            self.error = f"{self.job_name}: an unexpected error, please report it: {error!r}"


def _let_the_window_go_first() -> None:
    """Of this thread and those that it starts: on Linux each has a priority of its own."""
    if sys.platform == "linux":
        with suppress(OSError):
            now = os.getpriority(os.PRIO_PROCESS, get_native_id())
            os.setpriority(os.PRIO_PROCESS, get_native_id(), now + _NICENESS)


@atexit.register
def end_all() -> None:
    """Cancels all queues and waits for their threads: before Blender quits, and before the add-on
    goes.
    """
    queues = [queue for queue in _started if not queue.finished]
    for queue in queues:
        queue.cancel()
    for queue in queues:
        queue.join()


def running() -> Queue | None:
    """The Queue in progress that keeps the operators busy, or None."""
    return _running


def set_running(queue: Queue | None) -> None:
    """Notes that `queue` is in progress; None: that none is."""
    global _running
    _running = queue


def status_text(queue: Queue) -> str:
    """`Suzanne (2 of 5): Fairing, 45 %`."""
    position, count = queue.position
    which = f" ({position} of {count})" if count > 1 else ""
    doing = "Cancelling" if queue.cancelled else phase_text(queue.phase)
    return f"{queue.job_name}{which}: {doing}, {100 * queue.fraction:.0f} %"


def phase_text(phase: str) -> str:
    """The core's name of a phase as a user would say it."""
    return _PHASES.get(phase, phase.capitalize())


class ConsoleProgress:
    """Prints a line whenever another tenth of a job is done.

    An instance is the core's `progress`.
    """

    def __init__(self, name: str, stream: TextIO | None = None) -> None:
        self._name = name
        self._stream = stream or sys.stdout
        self._tenths = -1

    def __call__(self, fraction: float, phase: str) -> None:
        tenths = int(10 * fraction)
        if tenths > self._tenths:
            self._tenths = tenths
            print(
                f"{self._name}: {phase_text(phase)}, {10 * tenths} %", file=self._stream, flush=True
            )
