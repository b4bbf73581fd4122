# SPDX-License-Identifier: GPL-3.0-or-later
"""The boat builder's day of the examples, on the table that is done soonest."""

import boat_day
import hulls
import pytest


@pytest.mark.long
def test_from_a_table_to_step_in_under_25_clicks(tmp_path):
    found = boat_day.day(hulls.chine(), tmp_path)
    assert found["clicks"] < 25 and found["sections"] >= 8
    assert found["rms before"] > 5.0 and found["rms after"] < 1.5  # millimetres
    assert found["largest after"] < 4.0
    endings = {path.name.removeprefix("offsets_chine") for path in tmp_path.iterdir()}
    assert endings == {"_strain.csv", "_hydrostatics.csv", ".dxf", ".step"}
    assert "MANIFOLD_SOLID_BREP" in (tmp_path / "offsets_chine.step").read_text("ascii")
