# SPDX-License-Identifier: GPL-3.0-or-later
"""Skips work whose inputs have not changed, by their content, and prevents doing it twice at a time."""

import hashlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from layout import CACHE, ROOT


def files_under(*tops: Path) -> list[Path]:
    """All files in the given files and folders, without caches, in a fixed order."""
    found = []
    for top in tops:
        found += [top] if top.is_file() else [path for path in top.rglob("*") if path.is_file()]
    return sorted(path for path in found if "__pycache__" not in path.parts)


def fingerprint(files: Iterable[Path], *facts: str) -> str:
    """A hash of the files' names and contents, and of other `facts`."""
    digest = hashlib.sha256(repr(facts).encode())
    for path in files:
        digest.update(f"{path.relative_to(ROOT)}\0".encode())
        digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def is_fresh(stamp: Path, value: str) -> bool:
    """Whether the work that left `stamp` had the same inputs."""
    return stamp.is_file() and stamp.read_text() == value


def leave(stamp: Path, value: str) -> None:
    """Records that the work is done."""
    stamp.parent.mkdir(parents=True, exist_ok=True)
    stamp.write_text(value)


@contextmanager
def alone(work: str) -> Iterator[None]:
    """Waits until no other process does the same work; the lock ends with the process."""
    import fcntl  # not on Windows, where `dev.py wheels` runs

    CACHE.mkdir(exist_ok=True)
    with (CACHE / f"{work}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
