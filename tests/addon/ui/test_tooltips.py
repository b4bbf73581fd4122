# SPDX-License-Identifier: GPL-3.0-or-later
"""Every tooltip is one short sentence: people read it while they point at a button."""

import inspect
import re

import bpy

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


def faults(text):
    """What is wrong with one tooltip, in a word each."""
    found = ["more than a sentence"] if SENTENCE_ENDS.search(text) else []
    found += [f"{len(text)} characters"] if len(text) > LONGEST else []
    return found + ([] if text[:1].isupper() or text[:1].isdigit() else ["no capital"])


def test_every_tooltip_is_one_short_sentence():
    shown = {(where, text) for where, text in tooltips() if text}
    assert len(shown) > 100
    assert {where: (text, faults(text)) for where, text in shown if faults(text)} == {}
