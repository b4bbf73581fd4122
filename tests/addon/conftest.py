# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on in `bpy`, from the source tree; every test begins in an empty Blender."""

import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1]), str(HERE)]
bpy = pytest.importorskip("bpy")

import addon  # noqa: E402
from addon import prediction  # noqa: E402
from addon.live import full_level  # noqa: E402


def pytest_configure(config):
    config.addinivalue_line(
        "markers", "long: seconds of a processor, left out of `dev.py test quick`"
    )


@pytest.fixture(autouse=True)
def blender():
    """An empty scene with the add-on registered."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon.register()
    prediction.forget()
    yield bpy
    addon.unregister()


@pytest.fixture
def no_pause(monkeypatch):
    """Live begins the full level at once."""
    monkeypatch.setattr(full_level, "PAUSE", 0.0)
