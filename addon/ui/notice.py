# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences in a panel, broken into lines, since Blender's labels do not wrap."""

import textwrap
from typing import Any

import bpy

WIDTH = 33  # characters that fit a sidebar of default width


def draw_notice(layout: bpy.types.UILayout, text: str, icon: Any = "ERROR") -> None:
    box = layout.box().column(align=True)
    for line in textwrap.wrap(text, WIDTH):
        box.label(text=line, icon=icon)
        icon = "BLANK1"
