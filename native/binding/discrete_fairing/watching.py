# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress callbacks and monitors: checked before a run, and shared by several runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from . import _native
from .errors import fairing_error

Progress = Callable[[float, str], bool | None]


def check_watchers(progress: Progress | None, monitor: _native.Monitor | None) -> None:
    """Raises FairingError BAD_OPTION unless `progress` is callable and `monitor` is one, or None."""
    if progress is not None and not callable(progress):
        raise fairing_error(
            "BAD_OPTION",
            f"progress is {progress!r}; it must be callable, as progress(fraction, phase).",
        )
    if monitor is not None and not isinstance(monitor, _native.Monitor):
        raise fairing_error(
            "BAD_OPTION", f"monitor is {monitor!r}; it must be a discrete_fairing.Monitor."
        )


class SeveralRuns:
    """Combines the progress of several runs into one, which never decreases."""

    def __init__(self, progress: Progress | None, monitor: _native.Monitor | None, threads: int):
        self.threads = threads
        self._progress = progress
        self._monitor = monitor if monitor is not None else _native.Monitor()

    def run(self, begin: float, end: float) -> dict[str, Any]:
        """The watching arguments and threads for a run that covers [begin, end] of the progress."""

        def told(fraction: float, phase: str) -> bool | None:
            whole = begin + (end - begin) * fraction
            return self._tell(min(whole, end), self._monitor.phase if phase == "done" else phase)

        return {"threads": self.threads, "monitor": _native.Monitor(), "progress": told}

    def watchers(self, at: float) -> tuple[Any, Any]:
        """The same for a short run: monitor and progress, which stays `at` this fraction."""
        run = self.run(at, at)
        return run["monitor"], run["progress"]

    def finish(self) -> None:
        self._tell(1.0, "done")

    def _tell(self, fraction: float, phase: str) -> bool | None:
        self._monitor._report(phase, fraction)  # raises CANCELLED
        return None if self._progress is None else self._progress(self._monitor.fraction, phase)
