# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the reference are what the code does: defaults, what energies take, public names."""

import inspect
import re
from pathlib import Path

import discrete_fairing as df
import numpy as np
import pytest
from discrete_fairing.options import OPTIONAL, SETTINGS

from addon.preferences import DiscreteFairingPreferences
from addon.properties import FairingSettings

DOCS = Path(__file__).resolve().parents[2] / "docs"
REFERENCE = DOCS / "reference"


def table_rows(text, first):
    """Cells of the rows of the first table whose head begins with `first`."""
    lines = text[text.index(f"| {first}") :].split("\n\n")[0].splitlines()
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def default_argument(name):
    """Of an argument of fair(); None where it has none."""
    if name in SETTINGS:
        core = getattr(df._native.Options(), name)
        plain = core[0] if isinstance(core, list) and core else core
        return None if name in OPTIONAL else getattr(plain, "name", plain)
    default = inspect.signature(df.fair).parameters[name].default
    return None if default is inspect.Parameter.empty else default


def test_settings_have_the_defaults_that_their_page_says():
    text = (REFERENCE / "settings.md").read_text("utf-8")
    stated = dict(re.findall(r"`(\w+)`(?: \([\w ]+\))?, (on|off|[\d.]+)(?=°|,|;|$| |\n)", text))
    declared = FairingSettings.__annotations__
    checked = 0
    for name, value in stated.items():
        if name not in declared:
            continue
        default = declared[name].keywords["default"]
        if isinstance(default, bool):
            assert default == (value == "on"), name
        elif declared[name].keywords.get("subtype") == "ANGLE":
            assert np.degrees(default) == pytest.approx(float(value)), name
        else:
            assert default == float(value), name
        checked += 1
    assert checked > 15


def test_preferences_have_the_defaults_that_their_table_says():
    rows = table_rows((REFERENCE / "settings.md").read_text("utf-8"), "Preference |")
    for _, name, value, _ in rows:
        default = DiscreteFairingPreferences.__annotations__[name.strip("`")].keywords["default"]
        assert str(default) == value.strip("`"), name


def test_arguments_have_the_defaults_that_their_tables_say():
    text = (DOCS / "python" / "fair.md").read_text("utf-8").partition("\n### Energy")[0]
    checked = 0
    for names, value in re.findall(r"^\| ([^|]*) \| `?([^|`]*)`? \|", text, re.MULTILINE):
        for name in re.findall(r"`(\w+)`", names)[:1]:
            default = default_argument(name)
            said = value.strip().strip('"')
            if said in ("", "none"):
                assert default is None, name
            elif isinstance(default, bool) or default is None or isinstance(default, str):
                assert str(default) == said, name
            else:
                assert float(default) == float(said), name
            checked += 1
    assert checked > 30


# Each row of the table of energies: how fair is asked for it.
ENERGIES = ("thin_plate", "total_curvature", "minimum_variation")


def moebius_strip():
    """Nine quads around, joined with a half turn."""
    turns = 2 * np.pi * np.arange(9) / 9
    rim = [
        [
            (2 + s * np.cos(t / 2)) * np.cos(t),
            (2 + s * np.cos(t / 2)) * np.sin(t),
            s * np.sin(t / 2),
        ]
        for t in turns
        for s in (-0.5, 0.5)
    ]
    faces = [(2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1) for i in range(8)] + [(16, 1, 0, 17)]
    return np.array(rim), faces


CUBE = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
NORMALS = np.full((8, 3), np.nan)
NORMALS[7] = 1.0
ASKED = {
    "One-sided sheets": (moebius_strip(), {}),
    "Fixed normals (`normals`)": ((CUBE, SIDES), {"normals": NORMALS}),
    "Tension (`tension`)": ((CUBE, SIDES), {"tension": 0.5}),
    "`epsilon`": ((CUBE, SIDES), {"epsilon": 0.1}),
    '`method="back_leg"`': ((CUBE, SIDES), {"method": "back_leg"}),
    "Tolerance and weights": ((CUBE, SIDES), {"interpolation": "approximate", "tolerance": 0.1}),
    '`interpolation="limit"`': ((CUBE, SIDES), {"interpolation": "limit"}),
}


def takes(mesh, options, energy):
    try:
        df.fair(*mesh, levels=1, energy=energy, **options)
    except df.FairingError:
        return False
    return True


def test_the_table_of_energies_is_what_the_core_takes():
    rows = table_rows((DOCS / "python" / "fair.md").read_text("utf-8"), "| Thin plate")
    said = {what: [cell == "yes" for cell in cells] for what, *cells in rows}
    assert said.keys() == ASKED.keys()
    found = {
        what: [takes(mesh, options, energy) for energy in ENERGIES]
        for what, (mesh, options) in ASKED.items()
    }
    assert said == found


def test_every_public_name_of_the_package_is_explained():
    text = "".join(page.read_text("utf-8") for page in (DOCS / "python").glob("*.md"))
    missing = [n for n in df.__all__ if not re.search(rf"\b{n}\b", text)]
    assert missing == []
