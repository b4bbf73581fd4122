# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the command line for CAD files."""

import argparse

from ..settings import PatchOptions, Settings
from .places import is_cad
from .rna import OfOperator

_OPTIONS = OfOperator(
    "export_scene.fairing_step",
    fit_tolerance="fit_tolerance",
    fit_angle="fit_angle",
    unit="unit",
    force="force",
)


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("files for CAD (OUT ends in .step or .stp)")
    _OPTIONS.add(group)


def options_of(arguments: argparse.Namespace, settings: Settings) -> PatchOptions | None:
    """The options for CAD files; None if none is written. Raises ValueError for options that need one."""
    if not is_cad(arguments.output):
        _OPTIONS.refuse(arguments, "an output that ends in .step")
        return None
    levels = settings.levels if "levels" in vars(arguments) else 0
    return PatchOptions(fit_levels=levels, **_OPTIONS.said(arguments))
