# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on in `bpy`, from the source tree; every test begins in an empty Blender."""

import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1]), str(HERE)]
sys.path.append(
    str(HERE.parents[1] / "examples")
)  # last: other folders have files of the same names
bpy = pytest.importorskip("bpy")

from scenes import CUBE, add  # noqa: E402

import addon  # noqa: E402
from addon import prediction  # noqa: E402
from addon.live import full_level  # noqa: E402


def pytest_configure(config):
    config.addinivalue_line("markers", "plain: without Blender")
    config.addinivalue_line("markers", "long: seconds of a processor")


@pytest.fixture(autouse=True)
def blender(request):
    """An empty scene with the add-on registered; not for tests of plain arrays and values."""
    if request.node.get_closest_marker("plain"):
        yield
        return
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon.register()
    prediction.forget()
    yield bpy
    addon.unregister()


@pytest.fixture
def source():
    """A box with edges of 2, selected."""
    return add("Box", *CUBE)


@pytest.fixture
def no_pause(monkeypatch):
    """Live begins the full level at once."""
    monkeypatch.setattr(full_level, "PAUSE", 0.0)
