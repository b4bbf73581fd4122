# SPDX-License-Identifier: GPL-3.0-or-later
"""How messages begin: the count of elements, the first few ids, and the verb in agreement, as
base/error.h has it.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

_SHOWN = 5
_NOUNS = {"vertex": "vertices", "face": "faces", "edge": "edges", "crease": "creases"}
# of several, of one
_VERBS = {"are": "is", "have": "has", "were": "was"}
_LISTING = re.compile(r"(?P<count>\d+) (?P<noun>[a-z]+) \((?P<ids>[^)]*)\) (?P<verb>[a-z]+)")


def listing(kind: str, ids: Sequence[int], verb: str = "are") -> str:
    """`3 vertices (0, 4, 9) are`; edges are pairs of ids, laid end to end. `verb`: of several."""
    if kind in ("edge", "crease"):
        named = [f"{a}-{b}" for a, b in zip(ids[::2], ids[1::2])]
    else:
        named = [str(i) for i in ids]
    one = len(named) == 1
    noun = kind if one else _NOUNS[kind]
    shown = ", ".join([*named[:_SHOWN], *(["…"] if len(named) > _SHOWN else [])])
    return f"{len(named)} {noun} ({shown}) {_of_one(verb) if one else verb}"


def relisted(message: str, kind: str, ids: Sequence[int]) -> str:
    """A message of several elements of some `kind`, about other ids; one that lists none as it is."""
    found = _LISTING.search(message)
    if found is None or kind not in _NOUNS:
        return message
    noun = "crease" if found["noun"].startswith("crease") else kind
    listed, rest = listing(noun, ids, found["verb"]), message[found.end() :]
    if listed.startswith("1 "):
        rest = rest.replace(" and were ", " and was ", 1)
    return message[: found.start()] + listed + rest


def _of_one(verb: str) -> str:
    return _VERBS.get(verb) or (verb if verb.endswith(("s", "d")) else f"{verb}s")
