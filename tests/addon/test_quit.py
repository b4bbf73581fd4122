# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender quits in mid-run, the add-on is switched off: in a process of its own."""

import subprocess
import sys
import textwrap
from pathlib import Path

import discrete_fairing
import pytest

pytestmark = pytest.mark.plain

HERE = Path(__file__).resolve().parent
BEGIN = """
import sys, time
import bpy
import addon
from addon import core, queue
from addon.jobs.fair import Job
from addon.settings import Settings

bpy.ops.wm.read_factory_settings(use_empty=True)
addon.register()
bpy.ops.mesh.primitive_monkey_add()
settings = bpy.context.scene.discrete_fairing
settings.levels, settings.energy = 6, "TOTAL_CURVATURE"
work = queue.Queue([Job(bpy.context, bpy.context.object, Settings.of(settings))], core.module().Monitor)
work.start()
while work.fraction == 0:
    time.sleep(0.001)
"""


def run(script):
    paths = [str(HERE.parents[1]), str(Path(discrete_fairing.__file__).parents[1])]
    code = f"import sys; sys.path[:0] = {paths!r}\n" + BEGIN + textwrap.dedent(script)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and "Traceback" not in done.stderr, done.stderr
    return done.stdout


@pytest.mark.parametrize("end", ["", "sys.exit()", "bpy.ops.wm.quit_blender()"])
def test_quitting_in_mid_run(end):
    """The run is cancelled, and the process ends as it should."""
    assert "mid-run" in run(f"""
        assert not work.finished
        print("mid-run", flush=True)
        {end}
    """)


def test_the_add_on_goes_in_mid_run():
    assert "over True" in run("""
        assert not work.finished
        addon.unregister()
        print("over", work.finished and work.cancelled and work.error is None)
    """)
