# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes files that are complete or absent; all writing in the package and the add-on goes through here.

Data are written to a private folder beside the file, so that no planted link can redirect them. At the
end the new file replaces the old one.
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
    """`path` as text; raises FairingError BAD_OPTION if it names no file."""
    try:
        name = os.fsdecode(path)  # type: ignore[arg-type]
        os.fsencode(name)
    except (TypeError, UnicodeError):
        name = ""
    if not name or "\0" in name:
        raise fairing_error("BAD_OPTION", f"path is {path!r}; it must be the name of a file.")
    return name


@contextmanager
def whole_file(path: str | os.PathLike, suffix: str | None = None) -> Iterator[Path]:
    """A path to write to inside the `with`, in a private folder. Its name is that of the file, unless
    `suffix` is given.

    At the end the new file replaces the old one and keeps its permissions; a link stays a link. After an
    error nothing has changed, and an OSError names `path`. Pipes and devices get the bytes at the end.
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
            place = folder / (target.stem + (target.suffix if suffix is None else suffix))
            yield place
            if is_file:
                put(place, target)
            else:
                # a pipe or a device
                with place.open("rb") as source, target.open("wb") as out:
                    shutil.copyfileobj(source, out)
        finally:
            shutil.rmtree(folder, ignore_errors=True)
    except OSError as error:
        if error.errno is None:
            raise
        raise OSError(error.errno, error.strerror, name) from error


def real_place(path: str | os.PathLike) -> Path:
    """The file that a path leads to; raises OSError for circular links."""
    target = Path(os.path.realpath(path))
    if target.is_symlink():
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
    return target


def put(place: Path, target: Path) -> None:
    """Replaces the file `target` by a complete file, which takes over its permissions."""
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
