# SPDX-License-Identifier: GPL-3.0-or-later
"""A fixed budget of random calls, the same ones each time; `dev.py fuzz` goes on from there."""

import tempfile
from pathlib import Path

import pytest
import sound
import written
from cases import CORPUS, Case, cases, halves
from hypothesis import given, settings

KEPT = sorted(CORPUS.glob("*.json"))


@given(cases())
def test_any_input(case):
    sound.check(case)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
@given(written.calls())
def test_any_file(call):
    with tempfile.TemporaryDirectory() as folder:
        written.check(Path(folder), call)


@given(written.MATRIX)
def test_any_matrix(matrix):
    written.check_moved(matrix)


@given(halves())
@settings(max_examples=settings().max_examples // 4)
def test_any_half(case):
    sound.check(case)


@pytest.mark.parametrize("path", KEPT, ids=lambda path: path.stem)
def test_defects_stay_mended(path):
    sound.check(Case.read(path))


def test_the_corpus_is_there():
    assert KEPT
