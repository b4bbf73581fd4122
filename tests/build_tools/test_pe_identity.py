# SPDX-License-Identifier: GPL-3.0-or-later
"""Modules for Windows: the same bytes from any folder, other bytes from other code."""

import struct

import pytest
from cross.pe_identity import settled

HEAD, OPTIONAL, SECTION = (
    0x40,
    240,
    0x200,
)  # of the file: where the header, how long, where the data


def module(code=b"code", time=1, identity=b"i" * 16):
    """A module of one section: a debug directory of one entry, what it names, and code."""
    directory = struct.pack("<IIHH4I", 0, time, 0, 0, 2, 24, 0x1000 + 28, SECTION + 28)
    data = directory + b"RSDS" + identity + bytes(4) + code
    options = bytearray(OPTIONAL)
    struct.pack_into("<H", options, 0, 0x20B)
    struct.pack_into("<2I", options, 112 + 8 * 6, 0x1000, 28)
    head = b"PE\0\0" + struct.pack("<2H3I2H", 0x8664, 1, time, 0, 0, OPTIONAL, 0) + options
    head += b".rdata".ljust(8, b"\0") + struct.pack("<4I", len(data), 0x1000, len(data), SECTION)
    start = b"MZ".ljust(0x3C, b"\0") + struct.pack("<I", HEAD)
    return (start + head).ljust(SECTION, b"\0") + data


def test_time_and_the_linkers_identity_do_not_count():
    assert settled(module()) == settled(module(time=7, identity=b"j" * 16))


def test_other_code_has_another_identity():
    one, other = (settled(module(code)) for code in (b"code", b"core"))
    begin = SECTION + 28 + 4
    assert one[begin : begin + 16] != other[begin : begin + 16]
    assert one[begin : begin + 16] not in (bytes(16), b"i" * 16)


def test_all_else_is_kept():
    before, after = module(), settled(module())
    assert len(before) == len(after) and settled(after) == after
    assert sum(a != b for a, b in zip(before, after)) <= 4 + 4 + 16


def test_another_file_is_refused():
    with pytest.raises(ValueError, match="no module for Windows"):
        settled(b"\x7fELF".ljust(0x80, b"\0"))
