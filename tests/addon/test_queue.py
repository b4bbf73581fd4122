# SPDX-License-Identifier: GPL-3.0-or-later
"""The thread that computes: order, progress, cancel, failure; a real window's is tested there."""

from threading import Event, current_thread, main_thread

import pytest

from addon.errors import JobCancelled, JobError
from addon.operators.modal import status_text
from addon.queue import Queue

pytestmark = pytest.mark.plain


class Monitor:
    """The core's monitor, as far as a queue uses it."""

    def __init__(self):
        self.fraction, self.phase, self.cancelled = 0.0, "check", Event()

    def cancel(self):
        self.cancelled.set()


class Job:
    """Waits in the middle of its work until it may go on."""

    def __init__(self, name, triangles=100, error=None):
        self.name, self.triangles, self.error = name, triangles, error
        self.begun, self.go_on, self.on_thread = Event(), Event(), None

    def compute(self, monitor):
        self.on_thread = current_thread()
        monitor.fraction, monitor.phase = 0.5, "solve"
        self.begun.set()
        while not self.go_on.wait(0.001):
            if monitor.cancelled.is_set():
                raise JobCancelled(self.name)
        if self.error:
            raise self.error


def start(*jobs):
    queue = Queue(jobs, Monitor)
    queue.start()
    assert jobs[0].begun.wait(5)
    return queue


def test_jobs_run_in_order_on_a_thread_of_their_own():
    first, second = Job("A"), Job("B", 300)
    queue = start(first, second)
    assert queue.fraction == pytest.approx(0.125) and queue.position == (1, 2)
    assert status_text(queue) == "A (1 of 2): Fairing, 12 %"
    assert not second.begun.is_set()
    first.go_on.set()
    assert second.begun.wait(5)
    assert queue.fraction == pytest.approx(0.25 + 0.375)
    second.go_on.set()
    queue.join()
    assert queue.finished and queue.fraction == 1.0 and queue.error is None and not queue.cancelled
    assert first.on_thread is not main_thread()


def test_cancel_ends_the_job_and_those_that_wait():
    first, second = Job("A"), Job("B")
    queue = start(first, second)
    queue.cancel()
    queue.join()
    assert queue.cancelled and queue.error is None and not second.begun.is_set()


@pytest.mark.parametrize(
    "error, words", [(JobError("A: bad"), "A: bad"), (ZeroDivisionError(), "unexpected")]
)
def test_failure_is_kept(error, words):
    first, second = Job("A", error=error), Job("B")
    queue = start(first, second)
    first.go_on.set()
    queue.join()
    assert words in queue.error and not second.begun.is_set()
