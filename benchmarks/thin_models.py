# SPDX-License-Identifier: GPL-3.0-or-later
"""Models with thin walls and fins, beside those of the tests."""

import numpy as np
from from_tests import thin_walls

Model, plane, thickened, turned = (
    thin_walls.Model,
    thin_walls.plane,
    thin_walls.thickened,
    thin_walls.turned,
)


def ear() -> Model:
    """A cup of a blade that narrows upwards."""
    x, y = plane(7, 5, (80, 50))
    wide = 1 - 0.6 * (x / 80 + 0.5) ** 2
    return thickened(np.stack([x, y * wide, 0.03 * (y * wide) ** 2], axis=2), 3)


def leaf() -> Model:
    """A leaf: broad in the middle, narrow at both ends, arched."""
    x, y = plane(9, 4, (100, 40))
    wide = 0.15 + 0.85 * (1 - (x / 50) ** 2)
    return thickened(np.stack([x, y * wide, 0.01 * y**2 - 0.002 * x**2], axis=2), 1.2)


def fish_fin() -> Model:
    """A forked tail, thin beside its faces."""
    x, y = plane(6, 7, (60, 80))
    behind = x / 60 + 0.5
    return thickened(
        np.stack([x + 0.35 * behind * np.abs(y), y * (0.3 + 0.7 * behind), 0 * x], axis=2), 1.5
    )


def handle() -> Model:
    """A strap of 4 mm, bent to half a ring."""
    turn = np.linspace(0, np.pi, 7)[:, None]
    across = np.array([-10.0, 10.0])[None]
    return thickened(
        np.stack(
            [40 * np.cos(turn) + 0 * across, 30 * np.sin(turn) + 0 * across, across + 0 * turn],
            axis=2,
        ),
        4,
    )


def bottle() -> Model:
    """A bottle of 10 sides; its lip is 2 mm thick with edges of 9 mm."""
    profile = ((25, 0), (30, 5), (30, 90), (14, 120), (14, 140), (12, 140), (12, 120), (10, 110))
    return turned(profile, 10, 4)


def knob() -> Model:
    """A knob of 16 sides with a skirt of 1.5 mm."""
    profile = ((24, 0), (30, 0), (30, 1.5), (18, 4), (16, 18), (12, 20))
    return turned(profile, 16, 1)


def propeller() -> Model:
    """A blade that twists by a right angle."""
    x, y = plane(7, 4, (120, 30))
    turn = np.pi / 4 * x / 60
    return thickened(np.stack([x, y * np.cos(turn), y * np.sin(turn)], axis=2), 1.5)


MODELS = {
    "cup": thin_walls.cup,
    "phone case": thin_walls.phone_case,
    "sheet": thin_walls.sheet,
    "leaf": leaf,
    "ear": ear,
    "fish fin": fish_fin,
    "handle": handle,
    "wing": thin_walls.wing,
    "bottle": bottle,
    "knob": knob,
    "propeller": propeller,
}
