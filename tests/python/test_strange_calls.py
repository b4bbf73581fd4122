# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments that no caller should pass, and arrays that change in mid-run: errors with a code, and never a crash."""

import threading

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from discrete_fairing.options import SETTINGS
from refusing import refusal

POINTS, FACES = meshes.torus()
CORNERS, OFFSETS = FACES.reshape(-1), np.arange(0, 4 * len(FACES) + 1, 4)


def code_of(call, *arguments, **options):
    error = refusal(call, *arguments, **options)
    assert len(str(error)) > 15 and str(error)[-1] in ".)"
    return error.code


@pytest.mark.parametrize(
    "offsets", [[0, 10**9, 3], [0, -(10**9), 3], [0, 2**62, 3], [0, 2, 1, 3], [0, -1, 3]], ids=str
)
def test_a_size_is_not_predicted_from_offsets_that_lead_elsewhere(offsets):
    faces = (np.array([0, 1, 2]), np.array(offsets))
    assert code_of(df.predicted_size, 3, faces, 3) == "BAD_SHAPE"


@pytest.mark.parametrize(
    "arguments",
    [
        (10**10, FACES, 3),
        (2**31, FACES, 3),
        (2**70, FACES, 3),
        (2.5, FACES, 3),
        ("12", FACES, 3),
        (len(POINTS), FACES, 2.5),
        (len(POINTS), FACES, "3"),
        (len(POINTS), FACES, None),
        (len(POINTS), FACES, 3, 2**62),
        (len(POINTS), FACES, 3, 1.5),
        (len(POINTS), FACES, 3, -1),
        (len(POINTS), FACES, 3, 0, "cheap"),
    ],
    ids=lambda arguments: repr([a for a in arguments if a is not FACES]),
)
def test_a_size_is_not_predicted_from_what_is_no_number(arguments):
    assert code_of(df.predicted_size, *arguments) == "BAD_OPTION"


@pytest.mark.parametrize("watcher", [{"progress": 5}, {"progress": "print"}, {"monitor": 0}])
def test_watchers_are_looked_at_before_the_run(watcher):
    """The mesh has nothing to fair, and is not even read."""
    error = code_of(df.fair, POINTS[:0], FACES[:0], 2, **watcher)
    assert error == "BAD_OPTION"
    solver = df.Solver(POINTS, FACES, 1)
    assert code_of(solver.solve, **watcher) == "BAD_OPTION"
    assert not solver.solve().report["warm"]


class Scribbler(threading.Thread):
    """Writes nonsense into arrays and back, over and over, while a body runs."""

    def __init__(self, *arrays):
        super().__init__()
        self._arrays = [(array, array.copy()) for array in arrays]
        self._enough = threading.Event()

    def __enter__(self):
        self.start()

    def __exit__(self, *failure):
        self._enough.set()
        self.join()

    def run(self):
        while not self._enough.is_set():
            for array, good in self._arrays:
                array[...] = 2**40
                array[...] = good


@pytest.mark.parametrize("what", ["fair", "check", "mend", "solver", "predicted"])
def test_arrays_that_change_in_mid_run(what):
    """The call sees one state of the arrays, even if it is nonsense: an error, or the surface."""
    points, corners, offsets = POINTS.copy(), CORNERS.copy(), OFFSETS.copy()
    calls = {
        "fair": lambda: df.fair(points, (corners, offsets), 1),
        "check": lambda: df.check(points, (corners, offsets)),
        "mend": lambda: df.fair(points, (corners, offsets), 1, repair="mend"),
        "solver": lambda: df.Solver(points, (corners, offsets), 1).solve(points),
        "predicted": lambda: df.predicted_size(len(points), (corners, offsets), 1),
    }
    with Scribbler(corners, offsets, points):
        for _ in range(40):
            try:
                calls[what]()
            except df.FairingError as error:
                assert error.code not in ("OUT_OF_MEMORY",)
    calls[what]()


NUMBERS = sorted(set(SETTINGS) - {"measure"})


@pytest.mark.parametrize(
    "value", [True, np.True_, np.array(True)], ids=["bool", "NumPy's", "array"]
)
@pytest.mark.parametrize("name", NUMBERS)
def test_true_is_no_number(name, value):
    """weld=True would be a length of 1, and levels=True one level."""
    options = {"levels": 1, "repair": "mend", "interpolation": "approximate", name: value}
    for call in (df.fair, df.Solver):
        assert code_of(call, POINTS, FACES, **options) in ("BAD_OPTION", "BAD_SHAPE")
