# SPDX-License-Identifier: GPL-3.0-or-later
"""From cancelling a run to the error on the caller's side: the delay at moments spread over the
whole run.

A million triangles each, of few large and of many small control faces. BENCH_HUNDRED=1 adds a
hundred million, which take the memory for it. Delays are of the wall clock, where other work on the
machine is in them, and of the processor, all threads together, where it is not.
"""

import os
import statistics
import threading
import time
from collections.abc import Callable
from typing import Any

import control_meshes
import discrete_fairing as df
import table

MOMENTS = 50
CASES = {
    "1.3 M, 20 faces": (control_meshes.sphere, 1, 8, 50),
    "1.0 M, 62,720 faces": (control_meshes.sphere, 56, 2, 50),
    "1.0 M, 46,656 quads": (control_meshes.quad_sphere, 88, 2, 50),
}
HUNDRED_MILLIONS = {
    "84 M, 20 faces": (control_meshes.sphere, 1, 11, 200),
    "101 M, 1.6 M faces": (control_meshes.sphere, 281, 3, 200),
}


def clocks() -> tuple[float, float]:
    """Wall and processor."""
    return time.perf_counter(), time.process_time()


class Run:
    """A run on a thread of its own, until it is over or cancelled."""

    def __init__(self, job: Callable[[df.Monitor], Any]):
        self.monitor, self.over, self.finished = df.Monitor(), (0.0, 0.0), False
        self._job, self._thread = job, threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        try:
            self._job(self.monitor)
            self.finished = True
        except df.FairingError as error:
            if error.code != "CANCELLED":
                raise
        self.over = clocks()

    def cancel_after(self, seconds: float) -> tuple[str, float, float]:
        """The phase in which it was cancelled, and the seconds until the error came: wall,
        processor."""
        self._thread.join(seconds)
        phase, (wall, processor) = self.monitor.phase, clocks()
        self.monitor.cancel()
        self._thread.join()
        return phase, self.over[0] - wall, self.over[1] - processor


def delays(job: Callable[[df.Monitor], Any]) -> list[tuple[str, float, float]]:
    """Phases and seconds (wall, processor), for moments at equal distances; runs that were faster
    than the moment are left out."""
    start = time.perf_counter()
    job(df.Monitor())
    whole = time.perf_counter() - start
    found = []
    for k in range(MOMENTS):
        run = Run(job)
        delay = run.cancel_after(whole * (k + 0.5) / MOMENTS)
        if not run.finished:
            found.append(delay)
    return found


def measure(case: tuple, energy: str) -> dict[str, Any]:
    """One mesh under one energy."""
    make, size, levels, limit = case
    mesh = make(size)
    found = delays(lambda monitor: df.fair(*mesh, levels=levels, energy=energy, monitor=monitor))
    wall, processor = ([1e3 * entry[clock] for entry in found] for clock in (1, 2))
    phase, *_ = max(found, key=lambda entry: entry[2])
    return {
        "runs": len(found),
        "median": statistics.median(wall),
        "nineteen_in_twenty": statistics.quantiles(wall, n=20, method="inclusive")[-1],
        "largest": max(wall),
        "largest_processor": max(processor),
        "phase_of_largest": phase,
        "limit": limit,
        "all": found,
    }


def run() -> dict[str, Any]:
    """All meshes under thin plate and total curvature."""
    cases = {**CASES, **(HUNDRED_MILLIONS if os.environ.get("BENCH_HUNDRED") == "1" else {})}
    result, rows = {}, []
    for energy in ("thin_plate", "total_curvature"):
        for name, case in cases.items():
            entry = result[f"{name}, {energy}"] = measure(case, energy)
            keys = [key for key in entry if key != "all"]
            rows.append([f"{name}, {energy}", *(entry[k] for k in keys)])
    table.show(
        "Milliseconds from cancelling to the error",
        ["run", "cancelled", "median", "95 %", "largest", "by processor", "in phase", "limit"],
        rows,
    )
    return result


if __name__ == "__main__":
    run()
