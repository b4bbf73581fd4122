# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the program that solves the same linear system by sparse Cholesky (cholesky.cpp): CHOLMOD, and Eigen's SimplicialLDLT.

CHOLMOD's speed is that of the BLAS it finds at run time: Debian's reference BLAS is several times
slower than OpenBLAS (package libopenblas0-pthread). Which one it was is written beside the figures.
"""

import ctypes.util
import subprocess
from pathlib import Path

import numpy as np

PROGRAM = (
    Path(__file__).resolve().parent.parent
    / "build"
    / "bench"
    / "benchmarks"
    / "fairing_bench_cholesky"
)


def write_mesh(mesh: tuple[np.ndarray, np.ndarray], path: Path) -> None:
    """Writes a system in the text format of the program."""
    vertices, faces = mesh
    lines = [f"{len(vertices)} {len(faces)}"]
    lines += [" ".join(map(repr, p)) for p in vertices.tolist()]
    lines += [" ".join(map(str, [len(f), *f])) for f in faces.tolist()]
    path.write_text("\n".join(lines) + "\n")


def blas() -> str:
    """The path of the BLAS that CHOLMOD loads."""
    listing = subprocess.run(["ldd", str(PROGRAM)], capture_output=True, text=True).stdout
    paths = [
        line.split("=>")[1].split("(")[0].strip()
        for line in listing.splitlines()
        if "libblas" in line
    ]
    if not paths:
        return ctypes.util.find_library("blas") or "unknown"
    resolved = str(Path(paths[0]).resolve())
    return (
        "OpenBLAS"
        if "openblas" in resolved
        else "BLIS"
        if "blis" in resolved
        else f"reference ({Path(resolved).name})"
    )
