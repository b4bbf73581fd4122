# SPDX-License-Identifier: GPL-3.0-or-later
"""The command of the installed extension, as scripts call it: `blender --background --python headless_command_line.py`.

Prints `PASS name` or `FAIL name` for each test and exits with 1 if any failed. Each test starts this Blender again, with
the files it writes, and looks at exit codes and outputs.
"""

import contextlib
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness

POINTS = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 2)]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
LIMIT = 300  # seconds that no call takes


def words(*arguments):
    """The command line; `--background` as the documents have it."""
    return [
        bpy.app.binary_path,
        "--background",
        "--command",
        "discrete_fairing",
        *map(str, arguments),
    ]


def call(*arguments):
    """Exit code, standard output, standard error. The environment, with the user's folders, is handed on."""
    done = subprocess.run(words(*arguments), capture_output=True, timeout=LIMIT)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def write_obj(name):
    lines = ["v {} {} {}".format(*point) for point in POINTS]
    lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in FACES]
    Path(name).write_text("\n".join(lines) + "\n")


def obj_vertices(name):
    lines = [line.split() for line in Path(name).read_text().splitlines() if line.startswith("v ")]
    return [tuple(float(x) for x in line[1:4]) for line in lines]


def test_one_file():
    write_obj("in.obj")
    code, output, error = call("in.obj", "out.obj", "--levels", 2)
    assert code == 0, output + error
    assert set(POINTS) <= set(obj_vertices("out.obj")), "coordinates stay what they are"
    faces = [line for line in Path("out.obj").read_text().splitlines() if line.startswith("f ")]
    assert len(faces) == len(FACES) * 4**2
    assert "in.obj" in error and "→" in error


def test_help_and_version():
    code, output, _ = call("--help")
    assert code == 0 and "--crease-angle" in output
    code, output, _ = call("--version")
    assert code == 0 and re.search(r"discrete_fairing \d+\.\d+\.\d+", output), output


def test_ctrl_c_ends_it_with_130():
    write_obj("in.obj")
    process = subprocess.Popen(
        words("in.obj", "out.obj", "--levels", 10),
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
    )
    try:
        for line in process.stderr:
            if line.startswith("in.obj: "):  # progress: the core is at work
                break
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        process.stderr.read()
        assert process.wait(LIMIT) == 130, process.returncode
    finally:
        process.kill()
        process.stderr.close()
    assert not Path("out.obj").exists()


def in_a_folder(test):
    def run():
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            test()

    return run


harness.run({name: in_a_folder(test) for name, test in harness.tests_in(globals()).items()})
