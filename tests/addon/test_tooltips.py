# SPDX-License-Identifier: GPL-3.0-or-later
"""Every tooltip is one short sentence: people read it while they point at a button."""

import inspect
import re

import bpy
import pytest

LONGEST = 120  # characters: two lines of Blender's tooltip
SENTENCE_ENDS = re.compile(r"[.!?](?:\s|$)")


def ours(base):
    """The add-on's classes under one of Blender's."""
    for cls in base.__subclasses__():
        if cls.__module__.startswith("addon."):
            yield cls
        yield from ours(cls)


def tooltips():
    """(where, text) of all that is shown: buttons, settings, choices."""
    for operator in ours(bpy.types.Operator):
        if operator.__doc__:
            yield operator.__name__, inspect.cleandoc(operator.__doc__).replace("\n", " ")
    for owner in {
        *ours(bpy.types.Operator),
        *ours(bpy.types.PropertyGroup),
        *ours(bpy.types.AddonPreferences),
    }:
        for base in owner.__mro__:
            for name, declared in vars(base).get("__annotations__", {}).items():
                keywords = getattr(declared, "keywords", {})
                if "HIDDEN" in keywords.get("options", ()):
                    continue
                yield f"{owner.__name__}.{name}", keywords.get("description", "")
                items = keywords.get("items", ())
                for item in () if callable(items) else items:
                    yield f"{owner.__name__}.{name}, {item[0]}", item[2]


TOOLTIPS = sorted({(where, text) for where, text in tooltips() if text})


def test_there_are_tooltips():
    assert len(TOOLTIPS) > 100


@pytest.mark.parametrize(("where", "text"), TOOLTIPS, ids=[where for where, _ in TOOLTIPS])
def test_a_tooltip_is_one_short_sentence(where, text):
    assert not SENTENCE_ENDS.search(text), text
    assert len(text) <= LONGEST, f"{len(text)} characters: {text}"
    assert text[0].isupper(), text
