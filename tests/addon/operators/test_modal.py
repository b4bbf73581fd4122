# SPDX-License-Identifier: GPL-3.0-or-later
"""A long run in a window: where it says how far it is."""

from types import SimpleNamespace

import pytest

from addon.operators import modal


class Workspace:
    text = None

    def __init__(self, key):
        self.session_uid = key
        self.name_full = str(key)

    def status_text_set(self, text):
        self.text = text


@pytest.fixture
def workspaces(monkeypatch):
    found = [Workspace(1), Workspace(2), Workspace(3)]
    monkeypatch.setattr(modal, "bpy", SimpleNamespace(data=SimpleNamespace(workspaces=found)))
    return found


def window(*seen):
    """A context with a window for each of these workspaces."""
    manager = SimpleNamespace(windows=[SimpleNamespace(workspace=w, screen=None) for w in seen])
    for one in manager.windows:
        one.screen = SimpleNamespace(areas=[])
    return SimpleNamespace(window_manager=manager, workspace=seen[0])


def run():
    made = modal.ModalRun()
    made._told = set()
    return made


def test_the_status_is_taken_back_wherever_it_was_shown(workspaces):
    first, second, third = workspaces
    third.text = "somebody else's"
    made = run()
    made._show(window(first), "45 %")
    made._show(window(second), "90 %")
    assert (first.text, second.text) == ("45 %", "90 %")
    made._show(window(second), None)
    assert (first.text, second.text, third.text) == (None, None, "somebody else's")


def test_all_windows_say_it_and_a_workspace_may_be_deleted_meanwhile(workspaces):
    first, second, _ = workspaces
    made = run()
    made._show(window(first, second), "45 %")
    assert first.text == second.text == "45 %"
    workspaces.remove(first)
    made._show(window(second), None)
    assert second.text is None
