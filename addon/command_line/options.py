# SPDX-License-Identifier: GPL-3.0-or-later
"""The one list of settings as options of a command line."""

import argparse
from math import degrees, radians
from types import SimpleNamespace

from ..settings.properties import NAMES, DISCRETE_FAIRING_PG_settings

# Settings that mean something beside an open scene only, or for what no OBJ, PLY or STL file holds.
NOT_HERE = frozenset(
    (
        "mesh_source",
        "use_selection",
        "joint",
        "use_shape_keys",
        "copy_modifiers",
        "hide_source",
        "use_crease_attribute",
        "crease_threshold",
    )
)

_GROUPS = {
    "shape": ("levels", "energy", "interpolation", "tolerance", "boundary", "shade_smooth"),
    "creases": (
        "use_sharp_edges",
        "crease_angle",
        "corner_angle",
    ),
}


def add_settings(parser):
    """An option for every setting that the command line has."""
    groups = {name: parser.add_argument_group(name) for name in (*_GROUPS, "advanced")}
    for name in NAMES:
        if name in NOT_HERE or _switched_by_value(name):
            continue
        group = next((group for group, members in _GROUPS.items() if name in members), "advanced")
        _add(groups[group], name, _property(name))


def settings_of(arguments):
    """The parsed options as settings, with defaults for all that was not said. Raises ValueError if they contradict."""
    given = {name: value for name, value in vars(arguments).items() if name in NAMES}
    settings = {name: _default(_property(name)) for name in NAMES} | given
    for name in given:
        if "use_" + name in NAMES:
            settings["use_" + name] = True
    if "tolerance" in given:
        if given.get("interpolation") == "EXACT":
            raise ValueError("--tolerance needs --interpolation approximate")
        settings["interpolation"] = "APPROXIMATE"
    return SimpleNamespace(**settings)


def shown(settings):
    """The settings that the command line has, as a dict."""
    return {name: value for name, value in vars(settings).items() if name not in NOT_HERE}


def option(name):
    """`--crease-angle` for crease_angle; the word "use" says nothing beside --x and --no-x."""
    return "--" + name.removeprefix("use_").replace("_", "-")


def _switched_by_value(name):
    """Whether giving `--x` says all that the switch `use_x` could say."""
    return name.startswith("use_") and name.removeprefix("use_") in NAMES


def _property(name):
    return DISCRETE_FAIRING_PG_settings.bl_rna.properties[name]


def _default(prop):
    # Blender keeps single precision: 0.01 would come out as 0.0099999998
    return float(f"{prop.default:.7g}") if prop.type == "FLOAT" else prop.default


def _add(group, name, prop):
    kind = _KINDS.get(prop.type)
    if kind is None or getattr(prop, "is_array", False):
        raise TypeError(f"the setting {name} has no option yet: {prop.type}")
    # SUPPRESS: what is not said is absent, so that saying a default still counts as said
    group.add_argument(option(name), dest=name, default=argparse.SUPPRESS, **kind(name, prop))


def _boolean(_name, prop):
    shown = "on" if prop.default else "off"
    return {"action": argparse.BooleanOptionalAction, "help": _help(prop, shown)}


def _number(name, prop):
    angle = prop.subtype == "ANGLE"
    shown = degrees(prop.default) if angle else prop.default
    return {
        "type": _bounded(prop, int if prop.type == "INT" else float, angle),
        "metavar": "DEGREES" if angle else "N" if prop.type == "INT" else "X",
        "help": _help(prop, "off" if "use_" + name in NAMES else f"{shown:.4g}"),
    }


def _choice(_name, prop):
    spelled = {item.identifier.lower(): item for item in prop.enum_items}
    listed = "; ".join(f"{word}: {item.description}" for word, item in spelled.items())
    shown = prop.default.lower()

    def parse(text):
        word = text.replace("-", "_")  # as options themselves are spelled
        if word not in spelled:
            raise argparse.ArgumentTypeError(f"{text!r} is none of {', '.join(spelled)}")
        return spelled[word].identifier

    return {"type": parse, "metavar": "|".join(spelled), "help": _help(prop, shown, listed)}


def _text(_name, prop):
    return {"metavar": "TEXT", "help": _help(prop, prop.default or "empty")}


_KINDS = {"BOOLEAN": _boolean, "INT": _number, "FLOAT": _number, "ENUM": _choice, "STRING": _text}


def _bounded(prop, number, angle):
    """A parser of numbers that keeps Blender's own limits; in degrees for angles."""
    lowest, highest = (degrees(x) if angle else x for x in (prop.hard_min, prop.hard_max))

    def parse(text):
        try:
            value = number(text)
        except ValueError:
            value = None
        # the limits of angles went through radians in single precision
        if value is None or not lowest - 1e-4 * angle <= value <= highest + 1e-4 * angle:
            span = f"from {lowest:g}" + (f" to {highest:g}" if highest < 2**30 else "")
            whole = "a whole number " if number is int else "a number "
            raise argparse.ArgumentTypeError(f"{text!r} is not {whole}{span}")
        return radians(value) if angle else value

    return parse


def _help(prop, shown, more=""):
    # argparse reads % as a format
    return ". ".join(part for part in (prop.description, more) if part).replace("%", "%%") + f" [{shown}]"
