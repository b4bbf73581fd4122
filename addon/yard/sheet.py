# SPDX-License-Identifier: GPL-3.0-or-later
"""A table's text as cells with their positions, and the numbers in them. No Blender."""

import csv
import re
from dataclasses import dataclass
from math import isfinite, nan

# metres in each
UNITS = {
    "mm": 1e-3,
    "millimetres": 1e-3,
    "millimeters": 1e-3,
    "cm": 1e-2,
    "centimetres": 1e-2,
    "centimeters": 1e-2,
    "m": 1.0,
    "metres": 1.0,
    "meters": 1.0,
    "in": 0.0254,
    "inches": 0.0254,
    "ft": 0.3048,
    "feet": 0.3048,
    "feet-inches-eighths": 0.3048,
}
_BLANK = {"", "-", "–", "—"}
_FEET = re.compile(r"(-?)(\d+)-(\d+)-(\d+)(\+?)$")
_IN_BRACKETS = re.compile(r"[(\[]\s*([\w-]+)\s*[)\]]")
_IN_WORDS = re.compile(r"\b(?:in|units?:?)\s+([a-z-]+)", re.IGNORECASE)


class OffsetsError(ValueError):
    """Why a table cannot be read, as a sentence with row and column."""


@dataclass(frozen=True)
class Cell:
    """`row` and `column` count from 1, as spreadsheets do."""

    row: int
    column: int
    text: str

    @property
    def is_blank(self) -> bool:
        return self.text in _BLANK

    @property
    def word(self) -> str:
        """The text without a unit in brackets, in lower case."""
        return _IN_BRACKETS.sub("", self.text).strip().lower()

    def error(self, why: str) -> OffsetsError:
        return OffsetsError(f"Row {self.row}, column {self.column}: {why}")


@dataclass(frozen=True)
class Sheet:
    """A table: its head is the first row, and all rows have the same width."""

    rows: list[list[Cell]]
    keys: dict[str, Cell]  # rows above the head, such as `spacing, 1000`, by their first cell
    unit: float | None  # metres in a number; None if the file names no unit
    decimal_comma: bool

    def number(self, cell: Cell) -> float:
        """The number in the table's unit, or in metres for `feet-inches-eighths`; NaN if blank."""
        if cell.is_blank:
            return nan
        text = cell.text.replace(",", ".") if self.decimal_comma else cell.text
        feet = _FEET.match(text)
        if feet:
            sign, whole, inches, eighths, half = feet.groups()
            size = int(whole) + (int(inches) + (int(eighths) + 0.5 * bool(half)) / 8) / 12
            return (-size if sign else size) * 0.3048 / (self.unit or 0.3048)
        try:
            value = float(text)
        except ValueError:
            value = nan
        if not isfinite(value):
            raise cell.error(f"'{cell.text}' is not a number; leave unknown offsets blank")
        return value


def read_sheet(text: str) -> Sheet:
    """The sheet of comma, semicolon or tab separated values; raises OffsetsError."""
    lines = text.lstrip("\ufeff").splitlines()
    plain = [line for line in lines if line.strip() and not line.startswith("#")]
    joined = "\n".join(plain)
    separator = next((s for s in "\t;" if s in joined), ",")
    rows: list[list[Cell]] = []
    keys: dict[str, Cell] = {}
    units = [line for line in lines if line.startswith("#")]
    for number, line in enumerate(lines, 1):
        if line.startswith("#"):
            continue
        fields = [field.strip() for field in next(csv.reader([line], delimiter=separator), [])]
        cells = [Cell(number, k, field) for k, field in enumerate(fields, 1)]
        filled = [cell for cell in cells if not cell.is_blank]
        if not filled:
            continue
        if not rows and len(filled) <= 2:  # a title, or a name and its value
            units.append(" ".join(cell.text for cell in filled))
            keys[filled[0].word] = filled[-1]
        else:
            rows.append(cells)
    if len(rows) < 2:
        raise OffsetsError("Row 1, column 1: the file has no table: a head and rows below it")
    unit = _unit([*units, *(c.text for c in rows[0])])
    if unit is None and any(_FEET.match(cell.text) for row in rows[1:] for cell in row):
        unit = UNITS["feet"]
    return Sheet(_squared(rows), keys, unit, separator != ",")


def _squared(rows: list[list[Cell]]) -> list[list[Cell]]:
    head = rows[0]
    while head and head[-1].is_blank:
        head.pop()
    width = len(head)
    for row in rows[1:]:
        for cell in row[width:]:
            if not cell.is_blank:
                raise cell.error(f"'{cell.text}' stands right of the last column of the head")
        del row[width:]
        row += [Cell(row[0].row, k + 1, "") for k in range(len(row), width)]
    return rows


def _unit(texts: list[str]) -> float | None:
    for pattern in (_IN_BRACKETS, _IN_WORDS):
        for text in texts:
            for word in pattern.findall(text):
                if word.lower() in UNITS:
                    return UNITS[word.lower()]
    return None
