# SPDX-License-Identifier: GPL-3.0-or-later
"""A fixed budget of random calls, the same ones each time; `dev.py fuzz` goes on from there."""

import pytest
import sound
from cases import CORPUS, Case, cases
from hypothesis import given

KEPT = sorted(CORPUS.glob("*.json"))


@given(cases())
def test_any_input(case):
    sound.check(case)


@pytest.mark.parametrize("path", KEPT, ids=lambda path: path.stem)
def test_defects_stay_mended(path):
    sound.check(Case.read(path))


def test_the_corpus_is_there():
    assert KEPT
