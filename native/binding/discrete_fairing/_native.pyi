# SPDX-License-Identifier: GPL-3.0-or-later
"""The native core as the package calls it: contiguous arrays of the types named in native/binding."""

from collections.abc import Callable, Sequence
from enum import Enum
from typing import Any

import numpy as np

_Progress = Callable[[float, str], bool | None] | None

__version__: str
most_levels: int
curve_edge: int
boundary_edge: int
split_edge: int
straight_edge: int

class FairingError(ValueError):
    code: str
    cause: str
    cure: str
    elements: list[int]
    kind: str
    _sentences: tuple[str, str]

class Boundary(Enum):
    curve = 0
    linear = 1
    free = 2

class Chart(Enum):
    exponential = 0
    tangent = 1

class Energy(Enum):
    thin_plate = 0
    total_curvature = 1
    minimum_variation = 2

class Interpolation(Enum):
    exact = 0
    approximate = 1
    limit = 2

class Method(Enum):
    multigrid = 0
    back_leg = 1

class RegionContinuity(Enum):
    position = 0
    tangent = 1
    curvature = 2

class Repair(Enum):
    refuse = 0
    mend = 1

class Options:
    """One attribute a setting (AllSettings)."""

    def __getattr__(self, name: str) -> Any: ...
    def __setattr__(self, name: str, value: Any) -> None: ...

class Monitor:
    def cancel(self) -> None: ...
    @property
    def fraction(self) -> float: ...
    @property
    def phase(self) -> str: ...
    def _report(self, phase: str, fraction: float, /) -> None: ...

class Solver:
    def __init__(
        self, vertices: np.ndarray, corners: np.ndarray, offsets: np.ndarray, options: Options
    ) -> None: ...
    @property
    def bytes(self) -> int: ...
    def constants(self) -> dict[str, Any]: ...
    def rebase(self, vertices: np.ndarray) -> None: ...
    def require_own_process(self) -> None: ...
    def solve(
        self, vertices: np.ndarray, monitor: Monitor | None, progress: _Progress
    ) -> dict[str, Any]: ...

class Filler:
    def __init__(self, vertices: np.ndarray, corners: np.ndarray, offsets: np.ndarray) -> None: ...
    def find(
        self, monitor: Monitor, progress: _Progress
    ) -> tuple[list[list[int]], list[dict[str, Any]]]: ...
    def with_islands(
        self, loops: Sequence[Any], monitor: Monitor, progress: _Progress
    ) -> list[list[list[int]]]: ...
    def fill(
        self,
        holes: Sequence[Any],
        density: float,
        bends: bool,
        monitor: Monitor,
        progress: _Progress,
    ) -> tuple[list[Any], list[Any]]: ...
    def refine(
        self,
        points: np.ndarray,
        chosen: Sequence[int],
        fair: Sequence[int],
        monitor: Monitor,
        progress: _Progress,
    ) -> list[Any]: ...

def fair(
    vertices: np.ndarray,
    corners: np.ndarray,
    offsets: np.ndarray,
    shapes: np.ndarray,
    options: Options,
    monitor: Monitor,
    progress: _Progress,
    whole: dict[str, Any] | None = None,
) -> dict[str, Any]: ...
def strain(
    vertices: np.ndarray,
    corners: np.ndarray,
    offsets: np.ndarray,
    options: Options,
    monitor: Monitor,
    progress: _Progress,
) -> dict[str, Any]: ...
def fit(
    vertices: np.ndarray,
    corners: np.ndarray,
    offsets: np.ndarray,
    points: np.ndarray,
    normals: np.ndarray,
    triangles: np.ndarray,
    tolerance: float,
    weight: float,
    fixed: np.ndarray,
    options: Options,
    monitor: Monitor,
    progress: _Progress,
) -> dict[str, Any]: ...
def ease(
    vertices: np.ndarray,
    corners: np.ndarray,
    offsets: np.ndarray,
    tolerance: np.ndarray,
    amount: float,
    most: int,
    fixed: np.ndarray,
    options: Options,
    monitor: Monitor,
    progress: _Progress,
) -> dict[str, Any]: ...
def check(
    vertices: np.ndarray, corners: np.ndarray, offsets: np.ndarray
) -> list[dict[str, Any]]: ...
def require_readable(
    vertices: np.ndarray, corners: np.ndarray, offsets: np.ndarray, repair: Repair
) -> None: ...
def predicted_size(
    vertices: int,
    corners: np.ndarray,
    offsets: np.ndarray,
    levels: int,
    shapes: int,
    energy: Energy,
) -> dict[str, int]: ...
def outline(
    vertices: np.ndarray,
    corners: np.ndarray,
    offsets: np.ndarray,
    shapes: np.ndarray,
    options: Options,
    monitor: Monitor,
) -> dict[str, Any]: ...
def fit_splines(
    vertices: np.ndarray,
    triangles: np.ndarray,
    quads: np.ndarray,
    crease_edges: np.ndarray,
    groups: np.ndarray,
    levels: int,
    tolerance: float,
    normal_tolerance: float,
    threads: int,
    monitor: Monitor,
    progress: _Progress,
) -> dict[str, Any]: ...
def lattice_turns(
    vertices: np.ndarray,
    triangles: np.ndarray,
    quads: np.ndarray,
    crease_edges: np.ndarray,
    levels: int,
    least: float,
    threads: int,
    monitor: Monitor,
    progress: _Progress,
) -> np.ndarray: ...
def mended(
    vertices: np.ndarray,
    corners: np.ndarray,
    offsets: np.ndarray,
    monitor: Monitor,
    progress: _Progress,
) -> dict[str, Any] | None: ...
def to_flip(
    vertices: np.ndarray,
    corners: np.ndarray,
    offsets: np.ndarray,
    monitor: Monitor,
    progress: _Progress,
) -> np.ndarray: ...
def joined(count: int, pairs: np.ndarray) -> np.ndarray: ...
def border_fits(
    points: np.ndarray,
    vertex: np.ndarray,
    begin: np.ndarray,
    near: np.ndarray,
    degree: np.ndarray,
    along: np.ndarray,
    up: np.ndarray,
    soft: float,
    level: float,
    full_rank: float,
) -> tuple[np.ndarray, np.ndarray]: ...
def damped_solution(
    row: np.ndarray,
    column: np.ndarray,
    value: np.ndarray,
    columns: int,
    right: np.ndarray,
    steps: int,
    share: float,
) -> np.ndarray: ...
def _crossings(
    points: np.ndarray, triangles: np.ndarray, first: int, monitor: Monitor, progress: _Progress
) -> np.ndarray: ...
def error(code: str, cause: str, cure: str, elements: Sequence[int], kind: str) -> FairingError: ...
def text(sentence: str, kind: str, elements: Sequence[int]) -> str: ...
