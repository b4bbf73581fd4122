# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers on the command line: one reader, which says what it takes."""

import argparse
from collections.abc import Callable
from math import nan


def number(what: str, accepts: Callable[[float], bool]) -> Callable[[str], float]:
    """The `type` of an argument that is a number; `what`: "a length, 0 or more". NaN is to be refused."""

    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = nan
        if not accepts(value):
            raise argparse.ArgumentTypeError(f"{text!r} is not {what}")
        return value

    return read
