# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a file is: one line that is written over on a terminal, else a line for each phase."""


class Progress:
    """Shows the runs of one file's objects, one after another, as one."""

    def __init__(self, stream, file_name, runs):
        self._stream = stream
        self._name = file_name
        self._runs = runs
        self._done = 0
        self._shown = None
        self._over = stream.isatty()

    def __call__(self, fraction, phase):
        """What `discrete_fairing.fair` wants as its `progress`."""
        percent = int(100 * (self._done + fraction) / self._runs)
        state = (percent, phase) if self._over else (self._done, phase)
        if state == self._shown:
            return
        self._shown = state
        text = f"{self._name}: {percent:3d} % {phase}"
        self._stream.write(f"\r{text:<79}" if self._over else text + "\n")
        self._stream.flush()

    def next_run(self):
        self._done += 1

    def clear(self):
        """Leaves the line to whoever writes next."""
        if self._over and self._shown is not None:
            self._stream.write("\r" + " " * 79 + "\r")
            self._shown = None
