# SPDX-License-Identifier: GPL-3.0-or-later
"""Which level can be kept up with: the chosen one, or fewer where updates would be slow. No Blender."""

MOST = 250_000  # triangles; beyond them the level is lowered from the start
SLOW = 0.25  # seconds; an update that takes longer lowers the level by one


class Pace:
    """The live level of one surface."""

    def __init__(self):
        self._too_slow = None  # the lowest level that was

    def level(self, chosen, coarse_triangles):
        """The highest level up to `chosen` that can be kept up with; 1 whatever it takes."""
        level = chosen
        while level > 1 and coarse_triangles * 4**level > MOST:
            level -= 1
        return level if self._too_slow is None else max(1, min(level, self._too_slow - 1))

    def note(self, level, seconds):
        """Learns how long an update at `level` took."""
        if seconds > SLOW:
            self._too_slow = level
