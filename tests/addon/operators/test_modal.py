# SPDX-License-Identifier: GPL-3.0-or-later
"""A long run in a window shows its progress."""

from types import SimpleNamespace

import pytest

from addon.operators import modal

pytestmark = pytest.mark.plain


def workspace(key):
    made = SimpleNamespace(session_uid=key, name_full=str(key), text=None)
    made.status_text_set = lambda text: setattr(made, "text", text)
    return made


def window(*seen):
    """A context with a window for each of these workspaces."""
    screen = SimpleNamespace(areas=[])
    windows = [SimpleNamespace(workspace=each, screen=screen) for each in seen]
    return SimpleNamespace(window_manager=SimpleNamespace(windows=windows), workspace=seen[0])


@pytest.fixture
def workspaces(monkeypatch):
    found = [workspace(1), workspace(2), workspace(3)]
    monkeypatch.setattr(modal, "bpy", SimpleNamespace(data=SimpleNamespace(workspaces=found)))
    return found


def test_the_status_is_shown_in_all_windows_and_taken_back_wherever_it_was(workspaces):
    first, second, third = workspaces
    third.text = "somebody else's"
    made = modal.ModalRun()
    made._told = set()
    made._show(window(first, second), "45 %")
    assert (first.text, second.text) == ("45 %", "45 %")
    made._show(window(second), "90 %")
    made._show(window(second), None)
    assert (first.text, second.text, third.text) == (None, None, "somebody else's")
    made._show(window(first, second), "45 %")
    workspaces.remove(first)  # it may be deleted meanwhile
    made._show(window(second), None)
    assert second.text is None
