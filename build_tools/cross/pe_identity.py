# SPDX-License-Identifier: GPL-3.0-or-later
"""The identity of a module for Windows, from what is in it.

The linker takes it, for debuggers, from the paths of the object files too: each folder would make other bytes.
"""

import hashlib
import struct
from collections.abc import Iterator

CODEVIEW = 2  # kind of debug data
DEBUG = 6  # place in the table of data directories


def _offset(module: bytes, address: int) -> int:
    """Where in the file lies what is loaded to `address`, relative to the module's start."""
    (head,) = struct.unpack_from("<I", module, 0x3C)
    count, optional = (struct.unpack_from("<H", module, head + at)[0] for at in (6, 20))
    for section in range(head + 24 + optional, head + 24 + optional + 40 * count, 40):
        size, begin, _, place = struct.unpack_from("<4I", module, section + 8)
        if begin <= address < begin + size:
            return place + address - begin
    raise ValueError(f"no section holds {address:#x}")


def _debug_entries(module: bytes) -> Iterator[int]:
    """Where each entry of the debug directory lies in the file."""
    (head,) = struct.unpack_from("<I", module, 0x3C)
    address, size = struct.unpack_from("<2I", module, head + 24 + 112 + 8 * DEBUG)
    if size:
        begin = _offset(module, address)
        yield from range(begin, begin + size, 28)


def settled(module: bytes) -> bytes:
    """A 64-bit module whose times are zero and whose identity is a hash of all else."""
    made = bytearray(module)
    (head,) = struct.unpack_from("<I", made, 0x3C)
    if made[head : head + 4] != b"PE\0\0":
        raise ValueError("this is no module for Windows")
    made[head + 8 : head + 12] = bytes(4)
    identities = []
    for entry in _debug_entries(module):
        made[entry + 4 : entry + 8] = bytes(4)
        kind, _, _, place = struct.unpack_from("<4I", made, entry + 12)
        if kind == CODEVIEW and made[place : place + 4] == b"RSDS":
            identities.append(slice(place + 4, place + 20))
            made[identities[-1]] = bytes(16)
    digest = hashlib.sha256(made).digest()[:16]
    for identity in identities:
        made[identity] = digest
    return bytes(made)
