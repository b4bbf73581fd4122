# SPDX-License-Identifier: GPL-3.0-or-later
"""Chooses a level and an energy that are fast enough: the chosen ones, or less if updates would be
slow.

No Blender.
"""

from time import monotonic

MAX_TRIANGLES = 250_000  # above this the level is lowered from the start
SLOW = 0.25  # seconds; slower updates lower the level by one
IN_A_ROW = 2  # number of slow updates, since a single one may be caused by other processes
LIMIT = 1.5  # seconds; a longer solve is stopped
FAST = "thin_plate"


class Pace:
    """The live level and energy of one surface."""

    def __init__(self) -> None:
        self.least = 1  # the lowest level that the surface allows
        self._too_slow: int | None = None  # the lowest level that was too slow
        self._slow_ones = 0  # consecutive slow updates
        self.is_plain = False  # whether the fastest energy replaces the chosen one

    def level(self, chosen: int, coarse_triangles: int) -> int:
        """The highest level up to `chosen` that is fast enough; at least `least`."""
        level = chosen
        while level > self.least and coarse_triangles * 4**level > MAX_TRIANGLES:
            level -= 1
        return level if self._too_slow is None else max(self.least, min(level, self._too_slow - 1))

    def energy(self, chosen: str) -> str:
        """`chosen`, or the fastest energy if it has been too slow."""
        return FAST if self.is_plain else chosen

    def note(self, level: int, energy: str, seconds: float) -> None:
        self._slow_ones = self._slow_ones + 1 if seconds > SLOW else 0
        if self._slow_ones == IN_A_ROW:
            self._slow_ones = 0
            self.slow_down(level, energy, hopeless=False)

    def slow_down(self, level: int, energy: str, hopeless: bool) -> bool:
        """Reduces to the fastest energy if levels will not help, else by a level, if it can."""
        if energy != FAST and (hopeless or level == self.least):
            self.is_plain, self._too_slow = True, None
            return True
        self._too_slow = level
        return level > self.least


class Deadline:
    """A `progress` of the core that stops slow runs."""

    def __init__(self, seconds: float | None = None) -> None:
        """`seconds`: None for the LIMIT of an update."""
        self._end = monotonic() + (LIMIT if seconds is None else seconds)
        self.is_over = False

    def __call__(self, _fraction: float, _phase: str) -> bool:
        self.is_over = monotonic() > self._end
        return not self.is_over
