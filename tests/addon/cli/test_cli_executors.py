# SPDX-License-Identifier: GPL-3.0-or-later
"""The command's work in other processes and on a cluster: the same files, the same report."""

import os
import signal
import sys
import threading
import time
from pathlib import Path

import bpy
import psutil
import pytest
from cli_files import write_obj, write_ply
from cli_runs import CORE, PROCESS, ROOT, entries, run

from addon.cli import executors
from addon.cli import main as command


@pytest.fixture(autouse=True)
def no_blender(monkeypatch):
    """The command starts itself again without Blender here."""
    program = f"import sys; sys.path[:0] = {[str(ROOT), str(CORE)]}\n{PROCESS}"
    monkeypatch.setattr(executors, "blender_again", lambda: [sys.executable, "-c", program])


@pytest.fixture
def online():
    """As in a Blender that may use the network."""
    bpy.context.preferences.system.use_online_access = True
    yield
    bpy.context.preferences.system.use_online_access = False


def test_a_cluster_needs_online_access(capfd):
    write_obj("in.obj")
    code = run("in.obj", "out.obj", "--scheduler", "tcp://127.0.0.1:9")
    assert code == command.SOME_FAILED and "--online-mode" in capfd.readouterr().err


@pytest.fixture(scope="module")
def cluster():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None
    ) as made:
        yield made.scheduler_address


def three_files():
    write_obj("a.obj")
    write_ply("b.ply")
    write_obj("c.obj")
    return ["a.obj", "b.ply", "c.obj"]


def without_seconds(value):
    """The part of a report that two runs have in common."""
    if isinstance(value, dict):
        own = ("seconds", "threads", "peak_bytes", "output")
        return {key: without_seconds(item) for key, item in value.items() if key not in own}
    return [without_seconds(item) for item in value] if isinstance(value, list) else value


def test_files_side_by_side_are_those_of_one_process(capfd):
    names = three_files()
    Path("bad.obj").write_text("v 0 0 0\n")  # harms no other
    code, alone = entries(*names, "bad.obj", "alone/", "--levels", 2)
    assert code == command.SOME_FAILED
    lines = sorted(capfd.readouterr().err.splitlines())
    code, spread = entries(*names, "bad.obj", "spread/", "--levels", 2, "--jobs", 2)
    assert code == command.SOME_FAILED
    assert [record["status"] for record in spread] == ["done", "done", "done", "failed"]
    assert [record["output"] for record in spread[:3]] == [f"spread/{name}" for name in names]
    assert without_seconds(spread) == without_seconds(alone)
    for name in names:
        assert Path("spread", name).read_bytes() == Path("alone", name).read_bytes()
    said = sorted(capfd.readouterr().err.splitlines())
    assert any("error: bad.obj" in line for line in said)
    for name in names:
        (mine,) = [line for line in said if line.startswith(f"{name}: ")]
        (theirs,) = [line for line in lines if line.startswith(f"{name}: ") and "%" not in line]
        assert mine.partition(" in ")[0] == theirs.partition(" in ")[0]


def test_a_process_that_dies_is_told(capfd, monkeypatch):
    names = three_files()
    program = "import os, sys; sys.stderr.write('no more'); os._exit(9)"
    monkeypatch.setattr(executors, "blender_again", lambda: [sys.executable, "-c", program])
    code, records = entries(*names, "out/", "--jobs", 2)
    assert code == command.SOME_FAILED
    assert {record["status"] for record in records} == {"failed"}
    assert records[0]["error"]["code"] == "INTERNAL"
    assert "ended with code 9: no more" in capfd.readouterr().err


def test_pieces_in_two_processes():
    write_obj("in.obj")
    assert run("in.obj", "one.obj", "--levels", 3, "--pieces", 3) == 0
    code, (record,) = entries("in.obj", "two.obj", "--levels", 3, "--pieces", 3, "--jobs", 2)
    assert code == 0 and record["objects"][0]["report"]["pieces"]["count"] == 3
    assert Path("two.obj").read_text() == Path("one.obj").read_text()


def test_a_refusal_comes_back_from_another_process(capfd):
    write_obj("in.obj")
    words = ("--levels", 2, "--pieces", 2, "--jobs", 2, "--memory-limit", 1)
    code, (record,) = entries("in.obj", "out.obj", *words, "--levels", 9)
    assert code == command.SOME_FAILED
    assert record["error"]["code"] == "TOO_LARGE"


def test_files_and_pieces_on_a_cluster(online, cluster):
    names = three_files()
    assert run(*names, "alone/", "--levels", 2, "--quiet") == 0
    code, records = entries(*names, "spread/", "--levels", 2, "--scheduler", cluster)
    assert code == 0 and {record["status"] for record in records} == {"done"}
    for name in names:
        assert Path("spread", name).read_bytes() == Path("alone", name).read_bytes()
    words = ("a.obj", "--levels", 3, "--pieces", 3)
    assert run(*words, "one.obj") == run(*words, "two.obj", "--scheduler", cluster) == 0
    assert Path("two.obj").read_text() == Path("one.obj").read_text()


def test_an_interruption_ends_all_processes(capfd):
    names = three_files()
    sleeper = "import time; time.sleep(600)"
    threading.Timer(1.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(executors, "blender_again", lambda: [sys.executable, "-c", sleeper])
        code, records = entries(*names, "out/", "--jobs", 2)
    assert code == command.INTERRUPTED and time.monotonic() - begun < 60
    assert {record["status"] for record in records} == {"cancelled"}
    assert "interrupted" in capfd.readouterr().err
    processes = psutil.process_iter(["cmdline"])
    assert not [p.pid for p in processes if sleeper in (p.info["cmdline"] or ())]
