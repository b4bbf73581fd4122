# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are whole or not there: the one place through which everything here writes files.

What is written lies in a folder of its own beside the file, which nobody else may enter, so that no
planted link can lead it astray. At the end it takes the file's place.
"""

from __future__ import annotations

import errno
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import fairing_error


def file_name(path: object) -> str:
    """`path` as text; raises FairingError BAD_OPTION for what names no file."""
    try:
        name = os.fsdecode(path)  # type: ignore[arg-type]
        os.fsencode(name)
    except (TypeError, UnicodeError):
        name = ""
    if not name or "\0" in name:
        raise fairing_error("BAD_OPTION", f"path is {path!r}; it must be the name of a file.")
    return name


@contextmanager
def whole_file(
    path: str | os.PathLike, suffix: str | None = None, stem: str | None = None
) -> Iterator[Path]:
    """A name to write to inside the `with`, alone in its folder: the file's own, unless another
    `suffix` or `stem` is given.

    What is written takes the place of the file at the end, with the permissions of the file that was
    there; a link stays one. After an error nothing has changed, and an OSError names `path`. What is
    no file, such as a pipe, gets the bytes at the end.
    """
    name = file_name(path)
    try:
        target = real_place(name)
        mode = _mode(target)
        if mode is not None and stat.S_ISDIR(mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        is_file = mode is None or stat.S_ISREG(mode)
        beside = target.parent if is_file else None
        folder = Path(tempfile.mkdtemp(prefix=".", suffix=".part", dir=beside))
        try:
            place = folder / ((stem or target.stem) + (target.suffix if suffix is None else suffix))
            yield place
            if is_file:
                put(place, target)
            else:
                _copy(place, target)
        finally:
            shutil.rmtree(folder, ignore_errors=True)
    except OSError as error:
        if error.errno is None:
            raise
        raise OSError(error.errno, error.strerror, name) from error


def real_place(path: str | os.PathLike) -> Path:
    """Where a name leads; raises OSError where links lead in a circle."""
    target = Path(os.path.realpath(path))
    if target.is_symlink():
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
    return target


def put(place: Path, target: Path) -> None:
    """Moves a complete file to the place of another, whose permissions it takes over."""
    mode = _mode(target)
    mask = os.umask(0)
    os.umask(mask)
    place.chmod(0o666 & ~mask if mode is None else stat.S_IMODE(mode) & 0o777)
    place.replace(target)


def _mode(target: Path) -> int | None:
    try:
        return target.stat().st_mode
    except FileNotFoundError:
        return None


def _copy(place: Path, target: Path) -> None:
    """Into what is no file: a pipe, a device."""
    with place.open("rb") as source, target.open("wb") as out:
        shutil.copyfileobj(source, out)
