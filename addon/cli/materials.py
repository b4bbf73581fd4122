# SPDX-License-Identifier: GPL-3.0-or-later
"""The file of materials beside an OBJ: its name must not overwrite a file of another OBJ."""

import os
from collections.abc import Iterable
from itertools import chain, count
from pathlib import Path


def free_stem(target: Path) -> str:
    """A name for the materials of the OBJ `target`: its own, numbered if another file has it."""
    own = _named_in(target)
    names = chain([target.stem], (f"{target.stem}-{number}" for number in count(1)))
    return next(
        stem
        for stem in names
        if f"{stem}.mtl" in own or not os.path.lexists(target.with_name(f"{stem}.mtl"))
    )


def _named_in(target: Path) -> set[str]:
    """The materials that an OBJ names before its first vertex; a device is not read."""
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
