# SPDX-License-Identifier: GPL-3.0-or-later
"""Modules for macOS: the same bytes from any folder, other bytes from other code."""

import struct

import pytest
from cross.macho_identity import settled

AT = 32 + 8  # of the identity: after the header and its command's own


def module(code=b"code", identity=b"i" * 16, signature=b""):
    """A module of an identity, a signature if there is one, and code."""
    signed = bool(signature)
    commands = struct.pack("<2I", 0x1B, 24) + identity
    if signed:
        end = 32 + 24 + 16 + len(code)
        commands += struct.pack("<4I", 0x1D, 16, end, len(signature))
    head = struct.pack("<4I", 0xFEEDFACF, 0x0100000C, 0, 6)
    head += struct.pack("<4I", 1 + signed, len(commands), 0, 0)
    return head + commands + code + signature


def identity_of(made):
    return made[AT : AT + 16]


@pytest.mark.parametrize("signature", [b"", b"signature"])
def test_the_linkers_identity_does_not_count(signature):
    one, other = (
        settled(module(identity=letter * 16, signature=signature)) for letter in (b"i", b"j")
    )
    assert one == other and identity_of(one) not in (bytes(16), b"i" * 16)


def test_the_signature_does_not_count():
    one, other = (settled(module(signature=text)) for text in (b"one", b"two"))
    assert identity_of(one) == identity_of(other)


def test_other_code_has_another_identity():
    assert identity_of(settled(module())) != identity_of(settled(module(b"core")))


def test_all_else_is_kept():
    before, after = module(), settled(module())
    assert before[:AT] == after[:AT] and before[AT + 16 :] == after[AT + 16 :]
    assert settled(after) == after


def test_another_file_is_refused():
    with pytest.raises(ValueError, match="no module for macOS"):
        settled(b"\x7fELF".ljust(0x80, b"\0"))
