# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the command in this process, and reads its files."""

import os
import resource
import subprocess
import sys
from pathlib import Path

import numpy as np

from addon import core
from addon.cli import main as command
from addon.cli.files import read_file

ROOT = Path(__file__).resolve().parents[2]
CORE = Path(core.module().__file__).parents[1]  # of this process, for others


def run(*words):
    return command.main([str(word) for word in words])


def imported(path):
    """All vertices of a file, as Blender reads them, and the face sizes."""
    found = read_file(Path(path))
    positions = [vertex.co[:] for item in found for vertex in item.data.vertices]
    return np.array(positions), [
        len(face.vertices) for item in found for face in item.data.polygons
    ]


def contains(positions, wanted, tolerance):
    distance = np.linalg.norm(positions[:, None] - np.asarray(wanted)[None], axis=2)
    return (distance.min(axis=0) <= tolerance).all()


PROCESS = """
import os, sys
import addon
from addon.cli import _command
addon.register()
code = _command(sys.argv[1:])
sys.stdout.flush()
os._exit(code)  # as Blender does: bpy as a module is slow to end
"""


def process(*words, largest_file=resource.RLIM_INFINITY, **extra):
    """A process of its own with these variables: exit code, standard output, standard error. What it
    writes beyond `largest_file` bytes of a file is lost, as on a full disk.
    """
    done = subprocess.run(
        [sys.executable, "-c", PROCESS, *map(str, words)],
        env={
            "PYTHONPATH": os.pathsep.join((str(ROOT), str(CORE))),
            "PYTHONDONTWRITEBYTECODE": "1",  # half of it would be written under a limit
            "PATH": "",
            **extra,
        },
        capture_output=True,
        timeout=120,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (largest_file,) * 2),
    )
    return done.returncode, done.stdout.decode(), done.stderr.decode()
