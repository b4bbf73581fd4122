# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the command line: settings, and options for files, of CAD too."""

import argparse
from typing import Any

from ..properties import FAIRING_PG_settings
from ..settings import NAMES, OF_NEAR, PatchOptions, Settings
from . import clean, fit, places
from .places import is_cad
from .rna import OfOperator, add, default, number, option

_OF_CAD = OfOperator(
    "export_scene.fairing_step",
    fit_tolerance="fit_tolerance",
    fit_angle="fit_angle",
    unit="unit",
    force="force",
)


def _add_patch_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("files for CAD (OUT ends in .step or .stp)")
    _OF_CAD.add(group)


def patch_options_of(arguments: argparse.Namespace, settings: Settings) -> PatchOptions | None:
    """The options for CAD files; None if none is written. Raises ValueError for options that need one."""
    if not is_cad(arguments.output):
        _OF_CAD.refuse(arguments, "an output that ends in .step")
        return None
    levels = settings.levels if "levels" in vars(arguments) else 0
    return PatchOptions(fit_levels=levels, **_OF_CAD.said(arguments))


# Settings that apply only in an open scene, or to data that OBJ, PLY and STL files do not have.
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
    "shape": (
        "levels",
        "energy",
        "interpolation",
        "limit",
        "tolerance",
        "tolerance_group",
        "pull_group",
        "pad_size",
        "tension",
        "boundary",
        "symmetry_plane",
        "shade_smooth",
    ),
    "creases": ("use_sharp_edges", "crease_angle", "corner_angle"),
}

_PROGRAM = "blender --background --command discrete_fairing"
_DESCRIPTION = """\
Fairs every mesh of a file and writes the refined surfaces to another. Files are OBJ, PLY or STL, by their names; OUT
may also be a file of spline patches for CAD, as STEP. Coordinates are unchanged: no axes are
swapped, no units converted, whatever the formats."""
_EXAMPLES = f"""\
examples:
  {_PROGRAM} in.obj out.obj --levels 4
  {_PROGRAM} scan.ply fair.ply --tolerance 0.01 --crease-angle 40
  {_PROGRAM} hull.obj hull.step --unit m --fit-tolerance 1e-5
  {_PROGRAM} scan.stl closed.ply --clean --clean-noise --largest-hole 30
  {_PROGRAM} --fit scan.ply --cage cage.obj --tolerance 0.2 part.step
  for file in *.obj; do {_PROGRAM} "$file" "fair/$file" --quiet; done

exit codes:
  0 done, 1 failed, 2 wrong usage, 3 the native module is missing, 130 interrupted"""

_DISTANCE = number(float, 0)


def add_settings(parser: argparse.ArgumentParser) -> None:
    """Adds an option for every setting of the command line."""
    groups = {name: parser.add_argument_group(name) for name in (*_GROUPS, "advanced")}
    for name in NAMES:
        # 0 is a distance for --weld
        if name in NOT_HERE or name in ("weld", "tolerance") or _said_by_value(name):
            continue
        group = next((group for group, members in _GROUPS.items() if name in members), "advanced")
        # SUPPRESS: options that are not given are absent, so that a given default counts as given
        add(groups[group], name, _property(name), argparse.SUPPRESS, "use_" + name in NAMES)
    groups["shape"].add_argument(
        "--tolerance",
        type=_tolerance,
        default=argparse.SUPPRESS,
        metavar="X|X%",
        help="how far the surface may pass from each vertex, in the file's unit, or with %% in hundredths of the "
        "mean edge of each mesh: a little already removes most bumps [2%%]",
    )


def settings_of(arguments: argparse.Namespace) -> Settings:
    """The parsed options as settings, with defaults; raises ValueError if they contradict."""
    given = {name: value for name, value in vars(arguments).items() if name in NAMES}
    if given.get("weld") is None:
        given.pop("weld", None)
    settings = {name: default(_property(name)) for name in NAMES} | given
    if "tolerance" in given:
        settings["tolerance"], settings["tolerance_unit"] = given["tolerance"]
    for name in given:
        if "use_" + name in NAMES:
            settings["use_" + name] = True
    for name in OF_NEAR:
        if name in given:
            if (
                given.get("interpolation", "AUTO") not in ("AUTO", "APPROXIMATE")
                or "limit" in given
            ):
                raise ValueError(f"{option(name)} needs --interpolation approximate")
            settings["interpolation"] = "APPROXIMATE"
    if "limit" in given:
        if given.get("interpolation", "AUTO") not in ("AUTO", "LIMIT"):
            raise ValueError("--limit needs --interpolation limit")
        settings["interpolation"] = "LIMIT"
    if getattr(arguments, "weld", None) is not None and settings["repair"] != "MEND":
        raise ValueError("--weld needs --repair mend")
    return Settings(**settings)


def _tolerance(text: str) -> tuple[float, str]:
    share = text.endswith("%")
    value = _DISTANCE(text.removesuffix("%"))
    return (value / 100.0, "RELATIVE") if share else (value, "SCENE")


def _said_by_value(name: str) -> bool:
    """Whether another option implies this one: `--x` implies the switch `use_x`, a tolerance its unit."""
    return name == "tolerance_unit" or (
        name.startswith("use_") and name.removeprefix("use_") in NAMES
    )


def _property(name: str) -> Any:
    return FAIRING_PG_settings.bl_rna.properties[name]


def parser(version: str) -> argparse.ArgumentParser:
    """The parser; needs the add-on registered, since its settings become options."""
    made = argparse.ArgumentParser(
        prog=_PROGRAM,
        usage=f"{_PROGRAM} IN OUT [options]",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=_Formatter,
        allow_abbrev=False,  # the meaning of a script must not change when an option is added
    )
    places.add_options(made)
    made.add_argument(
        "--weld",
        type=_DISTANCE,
        metavar="DISTANCE",
        help="join vertices no farther apart than this, in the file's unit; 0: those at the same place "
        "[none]",
    )
    made.add_argument(
        "--threads",
        type=number(int, 0, 1024),
        metavar="N",
        help="0: all cores [as in the preferences]",
    )
    made.add_argument(
        "--quiet",
        action="store_true",
        help="no progress and no notes; errors and warnings are still written",
    )
    made.add_argument(
        "--version", action="version", version=version, help="print the versions and exit"
    )
    add_settings(made)
    _add_patch_options(made)
    fit.add_options(made)
    clean.add_options(made)
    return made


class _Formatter(argparse.RawDescriptionHelpFormatter):
    """Keeps texts as they are written; options have a column of their own."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, max_help_position=32, width=110)
