# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress, cancelling, runs at the same time, and Python at work beside a run."""

import threading
import time

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from every_call import CALLS
from refusing import refusal


def long_run():
    """A mesh whose run takes long enough to be watched."""
    return meshes.torus(40, 30)


def cancelled(**options) -> float:
    """Seconds that a run took until it ended as cancelled."""
    start = time.monotonic()
    error = refusal(df.fair, *long_run(), 5, **options)
    assert error.code == "CANCELLED" and list(error.elements) == []
    return time.monotonic() - start


@pytest.mark.parametrize("answer", [None, True, 0, "False"])
def test_only_false_cancels(answer):
    assert df.fair(*meshes.creature(), 2, progress=lambda fraction, phase: answer).report[
        "converged"
    ]


def test_returning_false_cancels():
    assert cancelled(progress=lambda fraction, phase: False) < 5


@pytest.mark.parametrize("reports", [1, 4])
def test_cancelling_while_patches_are_fitted(reports):
    """The call ends at once, and the same call gives the same bits afterwards."""
    mesh, options = meshes.random_hull(), {"levels": 5, "tolerance": 1e-7, "force": True}
    before, began = df.fit_patches(*mesh, **options), []

    def stop(fraction, phase):
        if phase == "patches":
            began.append(time.monotonic())
        return len(began) < reports

    assert (
        refusal(df.fit_patches, *mesh, **options, progress=stop).code == "CANCELLED"
        and time.monotonic() - began[-1] < 5
    )
    again = df.fit_patches(*mesh, **options)
    assert again.patch_points.tobytes() == before.patch_points.tobytes()


def test_an_exception_in_progress_comes_out():
    class Own(Exception):
        pass

    def fail(fraction, phase):
        raise Own("mine")

    with pytest.raises(Own, match="mine"):
        df.fair(*long_run(), 5, progress=fail)
    assert df.fair(*meshes.icosahedron(), 2).report["converged"]


def test_monitor_cancels_from_another_thread():
    monitor = df.Monitor()
    threading.Timer(0.1, monitor.cancel).start()
    assert cancelled(monitor=monitor) < 10


def test_monitor_is_watched_from_another_thread():
    """Python runs beside the core: another thread sees fractions between 0 and 1."""
    monitor, seen, stop = df.Monitor(), [], threading.Event()

    def watch():
        while not stop.is_set():
            seen.append((monitor.fraction, monitor.phase))
            time.sleep(0.002)

    watcher = threading.Thread(target=watch)
    watcher.start()
    df.fair(*meshes.creature(), 4, monitor=monitor)
    stop.set()
    watcher.join()
    assert len(seen) > 10 and {phase for _, phase in seen} >= {"solve"}
    assert any(0 < fraction < 1 for fraction, _ in seen)
    assert monitor.fraction == 1 and monitor.phase == "done"


def test_runs_beside_each_other():
    """Several threads fair a mesh each, and each gets the surface that it gets alone."""
    jobs = {
        name: (*meshes.ALL[name](), 3)
        for name in ("creature", "torus_quads", "random_hull", "wavy_patch", "house")
    }
    alone = {name: df.fair(*job).vertices for name, job in jobs.items()}
    together = {}

    def run(name):
        together[name] = [df.fair(*jobs[name], threads=2).vertices for _ in range(2)]

    threads = [threading.Thread(target=run, args=[name]) for name in jobs]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for name in jobs:
        assert all(np.array_equal(vertices, alone[name]) for vertices in together[name]), name


@pytest.mark.parametrize("name", CALLS)
def test_each_call_tells_its_progress_and_can_be_cancelled(name):
    seen = []
    CALLS[name](progress=lambda *heard: seen.append(heard))
    fractions, phases = zip(*seen)
    assert fractions == tuple(sorted(fractions)) and seen[-1] == (1, "done")
    monitor = df.Monitor()
    monitor.cancel()
    assert refusal(CALLS[name], monitor=monitor).code == "CANCELLED"
