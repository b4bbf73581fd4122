# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a table of offsets as points named by station and line. No Blender.

Three layouts, distinguished by their heads. `station, …`: a row for each station, a column for each
line. `line, …`, `waterline, …`, `buttock, …`: transposed. `station, line, x, y, z`: a row for each
point.
"""

import re
from dataclasses import dataclass
from math import cos, isnan, radians, sin

from .sheet import Cell, OffsetsError, Sheet, read_sheet

_QUANTITY = {"x": "x", "y": "y", "z": "z", "half-breadth": "y", "half breadth": "y", "height": "z"}
_LINE = re.compile(r"(wl|waterline|btk|buttock)\b[\s.]*(.*)$|(b)[\s.]*(\d.*)$")
_DIAGONAL = re.compile(r"diag(onal)?\b")
_LAST = re.compile(r"(.*?)[\s,:]+(x|y|z|half[- ]breadth|height)$", re.IGNORECASE)
_AXIS = {"w": "z", "b": "y"}  # the coordinate that the number of a waterline or buttock gives
_PROFILE = re.compile(r"stem|stern|profile")  # lines whose cells are positions along the hull
_SHARP = re.compile(r"knuckle|chine|sharp")
_STATION_PLACE = {"x", "position", "from bow", "from ap", "from fp"}
_ANGLE = "angle"  # angle of a diagonal below level, in degrees
_LINE_PLACE = {"height", "half-breadth", "half breadth", "position", "at"}


@dataclass(frozen=True)
class Offset:
    """A point on the hull: x along it, y the half-breadth, z up; metres."""

    station: str
    line: str
    place: tuple[float, float, float]

    @property
    def name(self) -> str:
        station = f"station {self.station}" if self.station[:1].isdigit() else self.station
        return f"{station}, {self.line}"


@dataclass(frozen=True)
class Offsets:
    """A table: `stations` and `lines` by name, in its order."""

    stations: list[str]
    lines: list[str]
    points: list[Offset]


@dataclass
class _Series:
    """A line's cells of one quantity, for all stations."""

    line: str
    quantity: str  # x, y, z; d: along a diagonal, from the middle
    # values of the line's own number; for a diagonal its height in the middle and its angle
    fixed: dict[str, float]
    head: Cell
    cells: list[Cell]


def is_sharp(line: str) -> bool:
    """Whether the name of a line indicates a knuckle."""
    return _SHARP.search(line.lower()) is not None


def is_waterline(line: str) -> bool:
    return line.lower().startswith("w") and _LINE.match(line.lower()) is not None


def is_buttock(line: str) -> bool:
    return line.lower().startswith("b") and _LINE.match(line.lower()) is not None


def is_diagonal(line: str) -> bool:
    return _DIAGONAL.match(line.lower()) is not None


def read(text: str, unit: float | None = None) -> Offsets:
    """The offsets in a text. `unit`: metres in a number, which overrides the file; raises OffsetsError."""
    sheet = read_sheet(text)
    scale = unit or sheet.unit
    if scale is None:
        raise sheet.rows[0][0].error(
            "no unit is named: write one in the head, as in 'station (mm)', or choose Unit in the import"
        )
    words = [cell.word for cell in sheet.rows[0]]
    known = {_QUANTITY.get(word) for word in words}
    if {"x", "y", "z"} <= known and "station" in words and "line" in words:
        points = _listed(sheet, words)
    elif words[0].startswith("station"):
        points = _by_station(sheet, sheet.rows, words[0])
    elif words[0].startswith(("line", "waterline", "buttock")):
        points = _by_station(sheet, [list(column) for column in zip(*sheet.rows)], words[0])
    else:
        raise sheet.rows[0][0].error(
            f"the head begins with '{sheet.rows[0][0].text}'; it begins with station, line, waterline or buttock, "
            "or names station, line, x, y and z"
        )
    found = [
        Offset(p.station, p.line, (scale * p.place[0], scale * p.place[1], scale * p.place[2]))
        for p in points
    ]
    if len({p.station for p in found}) < 2:
        raise OffsetsError(
            f"Row {sheet.rows[-1][0].row}, column 1: fewer than two stations have offsets"
        )
    lines = list(dict.fromkeys(p.line for p in found))
    return Offsets(list(dict.fromkeys(p.station for p in found)), lines, found)


def _listed(sheet: Sheet, words: list[str]) -> list[Offset]:
    at = {_QUANTITY.get(word, word): k for k, word in enumerate(words)}
    found, seen = [], set()
    for row in sheet.rows[1:]:
        station, line = row[at["station"]], row[at["line"]]
        for cell in (station, line):
            if cell.is_blank:
                raise cell.error("the point has no name of a station or line")
        if (station.text, line.text) in seen:
            raise line.error(f"station {station.text} has a second point on {line.text}")
        seen.add((station.text, line.text))
        cells = [row[at[axis]] for axis in "xyz"]
        blank = [cell for cell in cells if cell.is_blank]
        if len(blank) == 3:
            continue
        if blank:
            raise blank[0].error("the point has no number here, but others in its row")
        x, y, z = map(sheet.number, cells)
        found.append(Offset(station.text, line.text, (x, y, z)))
    return found


def _by_station(sheet: Sheet, rows: list[list[Cell]], head: str) -> list[Offset]:
    """Offsets from rows of stations, whose first row names the lines."""
    lines, body = rows[0], rows[1:]
    more: dict[str, list[Cell]] = {}  # rows on the lines themselves
    while body:
        words = [cell.word for cell in body[0][1:] if not cell.is_blank]
        if words and all(word in _QUANTITY for word in words):
            more["kind"] = body.pop(0)
        elif body[0][0].word in _LINE_PLACE:
            more["height"] = body.pop(0)
        elif body[0][0].word == _ANGLE:
            more[_ANGLE] = body.pop(0)
        else:
            break
    where = next((k for k in range(1, len(lines)) if lines[k].word in _STATION_PLACE), None)
    series = [
        _series(
            sheet,
            lines[k],
            {name: row[k] for name, row in more.items() if not row[k].is_blank},
            head,
            [r[k] for r in body],
        )
        for k in range(1, len(lines))
        if k != where
    ]
    _once(series)
    found, seen = [], set()
    for index, row in enumerate(body):
        station = row[0]
        if station.is_blank:
            raise station.error("this station has no name")
        if station.text in seen:
            raise station.error(f"there is a second station {station.text}")
        seen.add(station.text)
        x = _station_x(sheet, station, row[where] if where else None, index)
        found += _points(sheet, station, x, index, series)
    return found


def _station_x(sheet: Sheet, station: Cell, where: Cell | None, index: int) -> float | None:
    """The station's x; None for a profile, whose cells have it."""
    if where is not None and not where.is_blank:
        return sheet.number(where)
    if _PROFILE.search(station.word):
        return None
    if where is not None:
        raise where.error(f"station {station.text} has no place along the hull")
    spacing = sheet.keys.get("spacing") or sheet.keys.get("station spacing")
    return sheet.number(spacing) * index if spacing else sheet.number(station)


def _series(
    sheet: Sheet, head: Cell, more: dict[str, Cell], first: str, cells: list[Cell]
) -> _Series:
    """`more`: what the rows below the head say of this line."""
    label = head.text.split("(")[0].split("[")[0].strip()
    quantity = _QUANTITY[more["kind"].word] if "kind" in more else ""
    last = _LAST.match(label)
    if last and not quantity:
        label, quantity = last.group(1), _QUANTITY[last.group(2).lower()]
    own = _LINE.match(label.lower())
    family = label[0].lower() if own else ""
    rest = (own.group(2) or own.group(4) or "") if own else ""
    if not family and label[:1].isdigit():  # a bare number belongs to the first cell of the head
        family = next((word[0] for word in ("waterline", "buttock") if word in first), "")
        if not family:
            raise head.error(f"'{head.text}' is no name of a line: call it WL {label} or B {label}")
        rest, label = label, f"{'waterline' if family == 'w' else 'buttock'} {label}"
    fixed = {}
    if family:
        at = more.get("height", Cell(head.row, head.column, rest))
        fixed = {_AXIS[family]: sheet.number(at)}
        if isnan(fixed[_AXIS[family]]):
            raise head.error(f"{label} has no number: where it lies")
        quantity = quantity or ("y" if family == "w" else "z")
    elif is_diagonal(label) and not quantity:
        for name in ("height", _ANGLE):
            if name not in more:
                raise head.error(f"{label} needs its {name} in a row '{name}' below the head")
            fixed[name] = sheet.number(more[name])
        quantity = "d"
    elif "keel" in label.lower():
        quantity = quantity or "z"
    if not quantity:
        raise head.error(f"'{head.text}' does not say which offset it has: half-breadth or height")
    return _Series(label, quantity, fixed, head, cells)


def _once(series: list[_Series]) -> None:
    seen = set()
    for one in series:
        if (one.line, one.quantity) in seen:
            raise one.head.error(f"{one.line} has these offsets a second time")
        seen.add((one.line, one.quantity))


def _points(
    sheet: Sheet, station: Cell, x: float | None, index: int, series: list[_Series]
) -> list[Offset]:
    """The points of one station; a profile has positions along the hull as half-breadths."""
    broad = {one.line for one in series if one.quantity in "yd" or "y" in one.fixed}
    values: dict[str, dict[str, float]] = {}
    cells: dict[str, Cell] = {}
    for one in series:
        cell = one.cells[index]
        number = sheet.number(cell)
        known = values.setdefault(one.line, dict(one.fixed))
        if not isnan(number):
            known["x" if x is None and one.quantity == "y" else one.quantity] = number
            cells[one.line] = cell
            if one.quantity == "d":
                tilt = radians(known[_ANGLE])
                known["y"] = number * cos(tilt)
                known["z"] = known["height"] - number * sin(tilt)
    found = []
    for line, known in values.items():
        if line not in cells:
            continue
        if x is not None:
            known.setdefault("x", x)
        if x is None or line not in broad:
            known.setdefault("y", 0.0)
        missing = [axis for axis in "xyz" if axis not in known]
        if missing:
            name = {"x": "place along the hull", "y": "half-breadth", "z": "height"}[missing[0]]
            raise cells[line].error(f"{line} has no {name} at station {station.text}")
        found.append(Offset(station.text, line, (known["x"], known["y"], known["z"])))
    return found
