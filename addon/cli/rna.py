# SPDX-License-Identifier: GPL-3.0-or-later
"""Options from Blender's properties: their description, default and range; and plain numbers."""

import argparse
from collections.abc import Callable
from math import degrees, inf, nan, radians
from typing import Any

import bpy


def default(prop: Any) -> Any:
    # Blender's single precision would print 0.01 as 0.0099999998
    return float(f"{prop.default:.7g}") if prop.type == "FLOAT" else prop.default


def option(name: str) -> str:
    """`--crease-angle` for crease_angle; the word "use" is dropped for --x and --no-x."""
    return "--" + name.removeprefix("use_").replace("_", "-")


def number(
    kind: type, lowest: float, highest: float = inf, angle: bool = False
) -> Callable[[str], float]:
    """The `type` of a numeric argument in this range, int or float; an `angle` is given in degrees."""
    span = f"from {lowest:g} to {highest:g}" if highest < 2**30 else f"{lowest:g} or more"
    what = "a whole number" if kind is int else "a number"

    def read(text: str) -> float:
        try:
            value = kind(text)
        except ValueError:
            value = nan
        # the limits of angles were converted to radians in single precision
        if not lowest - 1e-4 * angle <= value <= highest + 1e-4 * angle or value == inf:
            raise argparse.ArgumentTypeError(f"{text!r} is not {what}, {span}")
        return radians(value) if angle else value

    return read


def add(
    group: argparse._ArgumentGroup, name: str, prop: Any, absent: Any = None, is_off: bool = False
) -> None:
    """Adds an option for `prop`; `absent`: its value if not given; `is_off`: no effect then."""
    kind = _KINDS.get(prop.type)
    if kind is None or getattr(prop, "is_array", False):
        raise TypeError(f"the setting {name} has no option yet: {prop.type}")
    group.add_argument(option(name), dest=name, default=absent, **kind(prop, is_off))


class OfOperator:
    """Options from an operator's properties, by their names here."""

    def __init__(self, operator: str, **properties: str) -> None:
        self._operator, self._properties = operator, properties

    def _all(self) -> dict[str, Any]:
        """All properties; available once the add-on is registered."""
        module, _, function = self._operator.partition(".")
        found = getattr(getattr(bpy.ops, module), function).get_rna_type().properties
        return {option: found[name] for option, name in self._properties.items()}

    def add(self, group: argparse._ArgumentGroup) -> None:
        for name, prop in self._all().items():
            add(group, name, prop)

    def said(self, arguments: argparse.Namespace) -> dict[str, Any]:
        values = {name: default(prop) for name, prop in self._all().items()}
        given = {name: getattr(arguments, name) for name in values}
        return values | {name: value for name, value in given.items() if value is not None}

    def refuse(self, arguments: argparse.Namespace, needed: str, *more: str) -> None:
        """Raises ValueError if one of the options is given, or of `more`, without what is `needed`."""
        refuse(arguments, needed, *self._properties, *more)


def refuse(arguments: argparse.Namespace, needed: str, *names: str) -> None:
    """Raises ValueError if one of these options is given without what is `needed`."""
    for name in names:
        if getattr(arguments, name) is not None:
            raise ValueError(f"{option(name)} needs {needed}")


def _boolean(prop: Any, _is_off: bool) -> dict[str, Any]:
    shown = "on" if prop.default else "off"
    return {"action": argparse.BooleanOptionalAction, "help": _help(prop, shown)}


def _number(prop: Any, is_off: bool) -> dict[str, Any]:
    angle = prop.subtype == "ANGLE"
    degrees_of = degrees if angle else float
    lowest, highest = degrees_of(prop.hard_min), degrees_of(prop.hard_max)
    return {
        "type": number(int if prop.type == "INT" else float, lowest, highest, angle),
        "metavar": "DEGREES" if angle else "N" if prop.type == "INT" else "X",
        "help": _help(prop, "off" if is_off else f"{degrees_of(prop.default):.4g}"),
    }


def _choice(prop: Any, _is_off: bool) -> dict[str, Any]:
    spelled = {item.identifier.lower(): item for item in prop.enum_items}
    listed = "; ".join(f"{word}: {item.description}" for word, item in spelled.items())
    shown = prop.default.lower()

    def parse(text: str) -> str:
        word = text.replace("-", "_")  # spelled like the options themselves
        if word not in spelled:
            raise argparse.ArgumentTypeError(f"{text!r} is not one of {', '.join(spelled)}")
        return spelled[word].identifier

    return {"type": parse, "metavar": "|".join(spelled), "help": _help(prop, shown, listed)}


def _text(prop: Any, _is_off: bool) -> dict[str, Any]:
    return {"metavar": "NAME", "help": _help(prop, prop.default or "none")}


_KINDS = {"BOOLEAN": _boolean, "INT": _number, "FLOAT": _number, "ENUM": _choice, "STRING": _text}


def _help(prop: Any, shown: str, more: str = "") -> str:
    # argparse formats %
    return (
        ". ".join(part for part in (prop.description, more) if part).replace("%", "%%")
        + f" [{shown}]"
    )
