# SPDX-License-Identifier: GPL-3.0-or-later
"""The file of materials beside an OBJ: named so that none is lost that belongs to another file."""

import os
from collections.abc import Iterable
from itertools import chain, count
from pathlib import Path


def free_stem(target: Path) -> str:
    """What the materials of the OBJ `target` may be called: as itself, or with a number where that
    is a file that `target`, as it is now, does not name.
    """
    own = _named_in(target)
    names = chain([target.stem], (f"{target.stem}-{number}" for number in count(1)))
    return next(
        stem
        for stem in names
        if f"{stem}.mtl" in own or not os.path.lexists(target.with_name(f"{stem}.mtl"))
    )


def _named_in(target: Path) -> set[str]:
    """The files of materials that an OBJ names before its first vertex, where exporters do; a device
    has none, and may never end.
    """
    if not target.is_file():
        return set()
    try:
        with target.open("rb") as stream:
            return set(_materials(stream))
    except OSError:
        return set()


def _materials(lines: Iterable[bytes]) -> Iterable[str]:
    for line in lines:
        word, _, name = line.strip().partition(b" ")
        if word in (b"v", b"f"):
            return
        if word == b"mtllib":
            yield os.fsdecode(name.strip())
