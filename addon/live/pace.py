# SPDX-License-Identifier: GPL-3.0-or-later
"""Which level and energy can be kept up with: those chosen, or less where updates would be slow.

No Blender.
"""

from time import monotonic, perf_counter

MAX_TRIANGLES = 250_000  # triangles; beyond them the level is lowered from the start
SLOW = 0.25  # seconds; updates that take longer lower the level by one
IN_A_ROW = 2  # so many of them: one alone may be the machine's doing
LIMIT = 1.5  # seconds; a solve that takes longer is broken off
FAST = "thin_plate"


class Pace:
    """The live level and energy of one surface."""

    def __init__(self) -> None:
        self._too_slow: int | None = None  # the lowest level that was
        self._slow_ones = 0  # in a row
        self.is_plain = False  # whether the fastest energy has to stand in

    def level(self, chosen: int, coarse_triangles: int) -> int:
        """The highest level up to `chosen` that can be kept up with; 1 whatever it takes."""
        level = chosen
        while level > 1 and coarse_triangles * 4**level > MAX_TRIANGLES:
            level -= 1
        return level if self._too_slow is None else max(1, min(level, self._too_slow - 1))

    def energy(self, chosen: str) -> str:
        """`chosen`, or the fastest where that has been too slow."""
        return FAST if self.is_plain else chosen

    def note(self, level: int, energy: str, seconds: float) -> None:
        """Learns how long an update took."""
        self._slow_ones = self._slow_ones + 1 if seconds > SLOW else 0
        if self._slow_ones == IN_A_ROW:
            self._slow_ones = 0
            self.slow_down(level, energy, hopeless=False)

    def slow_down(self, level: int, energy: str, hopeless: bool) -> bool:
        """Less from now on: the fastest energy where levels will not help, else one level.

        Whether there is less.
        """
        if energy != FAST and (hopeless or level == 1):
            self.is_plain, self._too_slow = True, None
            return True
        self._too_slow = level
        return level > 1


class Deadline:
    """The core's `progress`: breaks off what takes too long."""

    def __init__(self, seconds: float | None = None) -> None:
        """`seconds`: None for the LIMIT of an update."""
        self._end = monotonic() + (LIMIT if seconds is None else seconds)
        self.is_over = False

    def __call__(self, _fraction: float, _phase: str) -> bool:
        self.is_over = monotonic() > self._end
        return not self.is_over


class Clock:
    """Milliseconds of the parts of an update."""

    def __init__(self) -> None:
        self.parts: dict[str, float] = {}
        self._last = perf_counter()

    def lap(self, name: str) -> None:
        now = perf_counter()
        self.parts[name] = 1e3 * (now - self._last)
        self._last = now

    @property
    def total(self) -> float:
        return sum(self.parts.values())
