# SPDX-License-Identifier: GPL-3.0-or-later
"""Debian's Chromium without a window, with its graphics drawn by the processor."""

import subprocess
from pathlib import Path

GRAPHICS = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
PATIENCE = 15_000  # milliseconds of the page's own clock, for loading and drawing
TIME_LIMIT = 300  # seconds


def _run(address: str, *options: str) -> str:
    words = ["chromium", "--headless", "--no-sandbox", "--hide-scrollbars", *GRAPHICS]
    words += ["--force-prefers-reduced-motion", f"--virtual-time-budget={PATIENCE}"]
    done = subprocess.run(
        [*words, *options, address], check=True, timeout=TIME_LIMIT, capture_output=True, text=True
    )
    return done.stdout


def photograph(address: str, path: Path, size: tuple[int, int], *options: str) -> None:
    """A PNG of the page in a window of `size` pixels."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.unlink(missing_ok=True)
    _run(address, f"--window-size={size[0]},{size[1]}", f"--screenshot={path}", *options)


def html_of(address: str, *options: str) -> str:
    """The page's HTML after its scripts have run."""
    return _run(address, "--dump-dom", *options)
