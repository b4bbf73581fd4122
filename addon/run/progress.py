# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a run is, in words, and on the console of a Blender without a window."""

import sys

_PHASES = {
    "check": "Checking",
    "hierarchy": "Refining",
    "curves": "Drawing curves",
    "solve": "Fairing",
    "constrain": "Keeping the tolerance",
    "measure": "Measuring",
    "output": "Building the mesh",
    "done": "Done",
}


def phase_text(phase):
    """The core's name of a phase as a user would say it."""
    return _PHASES.get(phase, phase.capitalize())


class ConsoleProgress:
    """Prints a line whenever another tenth of a job is done. An instance is the core's `progress`."""

    def __init__(self, name, stream=None):
        self._name = name
        self._stream = stream or sys.stdout
        self._tenths = -1

    def __call__(self, fraction, phase):
        tenths = int(10 * fraction)
        if tenths > self._tenths:
            self._tenths = tenths
            print(f"{self._name}: {phase_text(phase)}, {10 * tenths} %", file=self._stream, flush=True)
