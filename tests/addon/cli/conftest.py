# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands run in a folder of their own."""

import pytest


@pytest.fixture(autouse=True)
def own_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
