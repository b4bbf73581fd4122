# SPDX-License-Identifier: GPL-3.0-or-later
"""What a worker of a cluster does with a piece, in a module that the worker can import."""

import os
import signal
from pathlib import Path

import discrete_fairing as df


def fair_file(path: Path, dies_once: Path | None = None) -> Path:
    """Writes a piece's part; if the file `dies_once` exists, deletes it and kills itself."""
    if dies_once is not None and dies_once.exists():
        dies_once.unlink()
        os.kill(os.getpid(), signal.SIGKILL)
    target = path.with_name(path.name.replace("piece", "part"))
    df.Piece.load(path).fair(threads=1).save(target)
    return target
