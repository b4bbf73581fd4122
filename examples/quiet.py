# SPDX-License-Identifier: GPL-3.0-or-later
"""Suppresses the output of Blender and Cycles."""

import ctypes
import os
import sys
from contextlib import contextmanager
from tempfile import TemporaryFile


@contextmanager
def quiet():
    """Suppresses standard output and standard error inside the `with`; shows both if it fails.

    Blender prints from C, past Python's streams, so the file descriptors themselves are redirected.
    """
    _flush()
    kept = {stream: os.dup(stream) for stream in (1, 2)}
    with TemporaryFile() as log:
        for stream in kept:
            os.dup2(log.fileno(), stream)
        failed = True
        try:
            yield
            failed = False
        finally:
            _flush()
            for stream, original in kept.items():
                os.dup2(original, stream)
                os.close(original)
            if failed:
                log.seek(0)
                sys.stderr.write(log.read().decode(errors="replace"))


def _flush():
    """Writes out the buffers of Python and of the C library, which otherwise come later."""
    sys.stdout.flush()
    sys.stderr.flush()
    ctypes.CDLL(None).fflush(None)
