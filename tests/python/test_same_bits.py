# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces have the same bits whatever the processor: with its newer instructions and without."""

import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).with_name("surface_hashes.py")
# glibc has its functions several times, and chooses by what the processor can do
OLD_PROCESSOR = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX2_Usable,-FMA_Usable"}


def run(*words, **extra):
    command = [sys.executable, SCRIPT, *words]
    return subprocess.run(
        command, env={**os.environ, **extra}, text=True, stdout=subprocess.PIPE, check=False
    )


@pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() != "x86_64",
    reason="hides instructions from glibc on x86-64",
)
def test_fused_multiply_add_changes_nothing(tmp_path):
    assert run("write", tmp_path / "hashes.json").returncode == 0
    other = run("compare", tmp_path / "hashes.json", **OLD_PROCESSOR)
    assert other.stdout.splitlines() == ["60 of 60 have the same bits"]
