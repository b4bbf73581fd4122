# SPDX-License-Identifier: GPL-3.0-or-later
"""Jobs one after another on a thread of their own: started, watched and cancelled from the main thread. No Blender."""

from threading import Thread

from .job_error import JobCancelled, JobError


class Queue:
    """A row of jobs; each has `name`, `triangles` and `compute(monitor=…)`.

    Nothing of Blender is touched on the thread: all that it runs is `Job.compute`.
    """

    def __init__(self, jobs, make_monitor):
        """`make_monitor()` gives the core's Monitor, one a job."""
        self.jobs = jobs
        self.error = None  # a sentence, once a job has failed
        self.cancelled = False
        self._monitors = [make_monitor() for _ in jobs]
        self._index = 0
        self._thread = Thread(target=self._run, name="discrete fairing", daemon=True)

    def start(self):
        self._thread.start()

    @property
    def finished(self):
        """Whether the thread has ended, by success or not."""
        return not self._thread.is_alive()

    @property
    def fraction(self):
        """Share of the work done, 0 to 1; a job counts by its triangles."""
        total = sum(job.triangles for job in self.jobs)
        done = sum(job.triangles for job in self.jobs[: self._index])
        if self._index < len(self.jobs):
            done += self._monitors[self._index].fraction * self.jobs[self._index].triangles
        return done / total if total else 1.0

    @property
    def phase(self):
        """The core's name of what it is doing."""
        return self._monitors[self._current].phase

    @property
    def job_name(self):
        return self.jobs[self._current].name

    @property
    def position(self):
        """`(2, 5)`: the second of five."""
        return self._current + 1, len(self.jobs)

    def cancel(self):
        """Makes the thread end soon."""
        self.cancelled = True
        for monitor in self._monitors:
            monitor.cancel()

    def join(self):
        """Waits for the thread's end."""
        self._thread.join()

    @property
    def _current(self):
        return min(self._index, len(self.jobs) - 1)

    def _run(self):
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
