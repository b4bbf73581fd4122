# SPDX-License-Identifier: GPL-3.0-or-later
"""The identity of a module for macOS, from what is in it.

The linker takes it, for debuggers, before these data are stripped, which name the folder where it was compiled.
"""

import hashlib
import struct
from collections.abc import Iterator

MAGIC = 0xFEEDFACF  # 64 bits, little-endian
IDENTITY, CODE_SIGNATURE = 0x1B, 0x1D  # kinds of load commands


def _commands(module: bytes) -> Iterator[tuple[int, int]]:
    """Kind and place of each load command."""
    magic, count = struct.unpack_from("<I12xI", module)
    if magic != MAGIC:
        raise ValueError("this is no module for macOS")
    at = 32
    for _ in range(count):
        kind, size = struct.unpack_from("<2I", module, at)
        yield kind, at
        at += size


def settled(module: bytes) -> bytes:
    """The module with a hash of its content as its identity. A signature does not count, and has to be made again."""
    places = dict(_commands(module))
    begin, end = places[IDENTITY] + 8, len(module)
    if CODE_SIGNATURE in places:
        (end,) = struct.unpack_from("<I", module, places[CODE_SIGNATURE] + 8)
    made = bytearray(module)
    made[begin : begin + 16] = bytes(16)
    identity = bytearray(hashlib.sha256(made[:end]).digest()[:16])
    identity[6] = identity[6] & 0x0F | 0x30  # as a UUID made of a hash is marked
    identity[8] = identity[8] & 0x3F | 0x80
    made[begin : begin + 16] = identity
    return bytes(made)
