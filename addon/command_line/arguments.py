# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be said on the command line."""

import argparse

from .options import add_settings
from .places import FORMATS

_PROGRAM = "blender --background --command discrete_fairing"

_DESCRIPTION = """\
Fairs every mesh of each input file and writes the refined surfaces to the output. Files are OBJ, PLY or STL, by their
names. Coordinates stay what they are: no axes are swapped, no units converted, whatever the formats."""

_EXAMPLES = f"""\
examples:
  {_PROGRAM} in.obj out.obj --levels 4
  {_PROGRAM} scan.ply fair.ply --tolerance 0.01 --crease-angle 40
  {_PROGRAM} parts/*.stl out/ --format ply
  {_PROGRAM} *.obj 'fair/{{name}}_fair.obj' --quiet --json report.json

exit codes:
  0 all done, 1 an input failed (the others are written), 2 wrong usage, 3 the native module is missing,
  130 interrupted"""


def parser(version):
    """The parser, which prints the text `version`. Needs the add-on registered: its settings become options."""
    made = argparse.ArgumentParser(
        prog=_PROGRAM,
        usage=f"{_PROGRAM} IN [IN …] OUT [options]",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=_Formatter,
        allow_abbrev=False,  # a script must not change its meaning when an option is added
    )
    made.add_argument("inputs", metavar="IN", nargs="+", help="OBJ, PLY or STL files")
    made.add_argument(
        "output",
        metavar="OUT",
        help="a file; for several inputs a folder (one that exists, or with / at its end) or a pattern with {name}, "
        "which stands for an input's name without its ending. Folders are made. A file that exists is overwritten, "
        "but never an input",
    )
    made.add_argument(
        "--format",
        choices=FORMATS,
        help="of the files in a folder [each like its input]",
        metavar="obj|ply|stl",
    )
    made.add_argument(
        "--overwrite",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="whether an output that exists is replaced; without, its input fails [on]",
    )
    made.add_argument(
        "--merge",
        action="store_true",
        help="join vertices at the same place in OBJ and PLY files too; those of STL files, which cannot share any, "
        "always are",
    )
    made.add_argument("--threads", type=_threads, metavar="N", help="0: all cores [as in the preferences]")
    made.add_argument(
        "--json", metavar="FILE|-", help="write a report; -: to standard output, which has nothing else"
    )
    made.add_argument(
        "--quiet", action="store_true", help="no progress and no table; errors are still written"
    )
    made.add_argument("--version", action="version", version=version, help="print the versions and leave")
    add_settings(made)
    return made


class _Formatter(argparse.RawDescriptionHelpFormatter):
    """Texts as they are written; options in a column of their own."""

    def __init__(self, prog):
        super().__init__(prog, max_help_position=32, width=110)


def _threads(text):
    if not text.isdecimal() or int(text) > 1024:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 0 to 1024")
    return int(text)
