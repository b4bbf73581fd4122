# SPDX-License-Identifier: GPL-3.0-or-later
"""The release's sample files: each opens as its page says, and its surface is computed again."""

import bpy
import pytest
import sample_files

LARGEST = 1_500_000  # bytes
NOT_FAIRED = {"scan"}  # whose hole is still open


@pytest.mark.long
@pytest.mark.parametrize("name", sample_files.SAMPLES)
def test_a_sample_opens_and_is_computed_again(name, tmp_path):
    path = sample_files.write(name, tmp_path)
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert path.stat().st_size < LARGEST
    active = bpy.context.view_layer.objects.active
    assert "Fairing" in bpy.data.texts["Read me"].as_string()
    if name in NOT_FAIRED:
        assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    else:
        assert active.discrete_fairing.source is not None
        assert bpy.ops.object.fairing_recompute() == {"FINISHED"}
