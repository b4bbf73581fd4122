# SPDX-License-Identifier: GPL-3.0-or-later
"""Threads that cannot be started, the end of the process in mid-run, and forks; each in a process of its own."""

import subprocess
import sys
import textwrap
from pathlib import Path

import discrete_fairing
import pytest

BEGIN = """
import os, sys, threading, time
import numpy as np
import control_meshes as meshes
import discrete_fairing as df

points, faces = meshes.creature()

def code_of(call, *arguments):
    try:
        call(*arguments)
    except df.FairingError as error:
        return error.code
"""
forks = pytest.mark.skipif(not hasattr(__import__("os"), "fork"), reason="no forks here")
limits = pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are Linux's")


def run(script, before=None):
    """The words that a script prints; the test fails if the script does not end well within a minute."""
    paths = [str(Path(__file__).parent), str(Path(discrete_fairing.__file__).parents[1])]
    code = f"import sys; sys.path[:0] = {paths!r}\n" + BEGIN + textwrap.dedent(script)
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, preexec_fn=before
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout.split()


@pytest.mark.parametrize("body", ["check", "fair", "solver", "loop", "watched", "update"])
def test_a_daemon_thread_at_work_does_not_spoil_the_end(body):
    """The run is cancelled, and the interpreter waits; a thread that tries again gets the same."""
    assert run(f"""
        def loop():
            while True:
                code_of(df.fair, points, faces, 3)

        solver = df.Solver(points, faces, 5)
        bodies = {{
            "check": lambda: [df.check(points, faces) for _ in iter(int, 1)],
            "fair": lambda: df.fair(points, faces, 8, "total_curvature"),
            "solver": lambda: df.Solver(points, faces, 7, "total_curvature").solve(),
            "loop": loop,
            "watched": lambda: df.fair(points, faces, 8, progress=lambda *_: time.sleep(0.01)),
            "update": lambda: [solver.solve(points * (1 + k % 7)) for k in iter(int, 1)],
        }}

        def work():
            try:
                bodies["{body}"]()
            except df.FairingError:
                pass

        for _ in range(3):
            threading.Thread(target=work, daemon=True).start()
        time.sleep(0.5)
        print("end", flush=True)
    """) == ["end"]


@forks
def test_a_solver_says_that_it_has_stayed_behind_in_the_parent():
    """The forked process can call it, delete it and leave it over at exit; it serves the parent as before."""
    out = run("""
        solver, spare = df.Solver(points, faces, 2), df.Solver(points, faces, 1)
        expected = solver.solve().vertices
        sys.stdout.flush()
        child = os.fork()
        if child == 0:
            print(code_of(solver.solve), code_of(solver.rebase, points), flush=True)
            del spare
            own = df.fair(points, faces, 2).vertices
            other = df.Solver(points, faces, 2).solve().vertices
            print(np.array_equal(own, expected) and np.array_equal(other, expected), flush=True)
            sys.exit(0)
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
        print(np.array_equal(solver.solve().vertices[: len(points)], points))
    """)
    assert out == ["FORKED", "FORKED", "True", "0", "True"]


@forks
def test_a_fork_in_mid_run_ends_the_run_in_the_child_alone():
    """The callback forks, or another thread does; the child ends at once."""
    out = run("""
        children = []

        def fork_once(fraction, phase):
            if not children:
                children.append(os.fork())

        code = code_of(lambda: df.fair(points, faces, 5, progress=fork_once))
        if children[0] == 0:
            print(code, flush=True)
            sys.exit(0)
        print(os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1]), code, flush=True)

        monitor = df.Monitor()
        args = (points, faces, 7)
        thread = threading.Thread(target=lambda: code_of(lambda: df.fair(*args, monitor=monitor)))
        thread.start()
        while monitor.fraction == 0:
            time.sleep(0.001)
        child = os.fork()
        if child == 0:
            print(code_of(df.fair, points, faces, 1), flush=True)
            sys.exit(0)
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
        monitor.cancel()
        thread.join()
    """)
    assert out == ["FORKED", "0", "None", "None", "0"]


def little_room():
    """Stacks so large that only few threads find room."""
    import resource

    resource.setrlimit(resource.RLIMIT_STACK, (1 << 29, resource.RLIM_INFINITY))
    resource.setrlimit(resource.RLIMIT_AS, (5 << 29, resource.RLIM_INFINITY))


@limits
def test_threads_that_cannot_be_started_are_done_without():
    out = run(
        """
        try:
            result = df.fair(points, faces, 2, threads=64)
        except df.FairingError as error:
            print(error.code)
            raise
        print(result.report["threads"] < 64, flush=True)
        print(np.array_equal(result.vertices, df.fair(points, faces, 2, threads=1).vertices))
        """,
        little_room,
    )
    assert out == ["True", "True"]
