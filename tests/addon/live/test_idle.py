# SPDX-License-Identifier: GPL-3.0-or-later
"""While no one uses the add-on it does next to nothing."""

import numpy as np
from live_scenes import follow, live, pull
from scenes import activate, fair, weights

from addon.mesh import groups


def test_no_operator_is_called_in_a_handler(source, monkeypatch):
    source.vertex_groups.new(name="Theirs").add([0, 1, 2], 0.5, "REPLACE")
    source.vertex_groups["Theirs"].add([1], 0.25, "REPLACE")
    target = fair(levels=2)
    target.vertex_groups.new(name="Mine").add([0, 9], 0.125, "REPLACE")
    expected = weights(target, "Theirs")

    def refuse(*_):
        raise AssertionError("an operator in a handler")

    monkeypatch.setattr(groups, "_convert", refuse)
    activate(target)
    live(target)
    target.discrete_fairing_live.levels = 1
    target.update_tag()
    follow()
    pull(source)
    assert not target.discrete_fairing_live.status.count("unexpected")
    assert len(target.data.polygons) == 6 * 4
    shown = weights(target, "Theirs")
    assert np.array_equal(shown[:8], expected[:8], equal_nan=True) and np.nanmax(shown) == 0.5
    assert target.vertex_groups["Mine"].weight(0) == 0.125
