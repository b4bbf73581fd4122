# SPDX-License-Identifier: GPL-3.0-or-later
"""What a worker of a cluster does with a piece, in a module that the worker can import."""

import os
import signal
from pathlib import Path

import discrete_fairing as df


def fair_file(path: Path, dies_once: Path | None = None) -> Path:
    """Reads a piece, writes its part and returns the file's name. If the file `dies_once` exists, it deletes that
    file and kills its own process."""
    if dies_once is not None and dies_once.exists():
        dies_once.unlink()
        os.kill(os.getpid(), signal.SIGKILL)
    target = path.with_name(path.name.replace("piece", "part"))
    df.Piece.load(path).fair(threads=1).save(target)
    return target
