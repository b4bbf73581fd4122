# SPDX-License-Identifier: GPL-3.0-or-later
"""A parser of numbers for the command line whose errors say what is accepted."""

import argparse
from collections.abc import Callable
from math import nan


def number(what: str, accepts: Callable[[float], bool]) -> Callable[[str], float]:
    """The `type` of a numeric argument; `what`: its description, such as "a length, 0 or more". Refuses
    NaN.
    """

    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = nan
        if not accepts(value):
            raise argparse.ArgumentTypeError(f"{text!r} is not {what}")
        return value

    return read
