# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of offsets: layouts, units, blanks, numbers; errors that name row and column; the mesh."""

from collections import Counter

import hulls
import numpy as np
import pytest
from scenes import EXAMPLES

from addon.yard.hull_mesh import hull_mesh
from addon.yard.offsets import read
from addon.yard.sheet import OffsetsError

pytestmark = pytest.mark.plain

# one hull of two stations, three waterlines and a sheer, in every layout
LAYOUTS = {
    "by station": """station (mm),x,Keel height,WL 0,WL 300,Sheer half-breadth,Sheer height
FP,0,-50,10,40,60,500
1,1000,-100,300,400,500,450
""",
    "by line": """unit,mm
line,offset,FP,1
x,,0,1000
Keel,height,-50,-100
WL 0,half-breadth,10,300
WL 300,half-breadth,40,400
Sheer,half-breadth,60,500
Sheer,height,500,450
""",
    "by waterline": """waterline (mm);FP;1
x;0;1000
0;10;300
300;40;400
Keel height;-50;-100
Sheer half-breadth;60;500
Sheer height;500;450
""",
    "decimal comma": """station (m);x;Keel height;WL 0;WL 0,3;Sheer half-breadth;Sheer height
FP;0;-0,05;0,01;0,04;0,06;0,5
1;1;-0,1;0,3;0,4;0,5;0,45
""",
    "tabs, named waterlines": """station (m)\tx\tKeel height\tWL low\tWL high\tSheer half-breadth\tSheer height
height\t\t\t0\t0.3\t\t
FP\t0\t-0.05\t0.01\t0.04\t0.06\t0.5
1\t1\t-0.1\t0.3\t0.4\t0.5\t0.45
""",
    "points": """station,line,x (mm),y,z
FP,Keel,0,0,-50
FP,WL 0,0,10,0
FP,WL 300,0,40,300
FP,Sheer,0,60,500
1,Keel,1000,0,-100
1,WL 0,1000,300,0
1,WL 300,1000,400,300
1,Sheer,1000,500,450
""",
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_each_layout_is_the_same_hull(layout):
    expected = [(0, 0, -0.05), (0, 0.01, 0), (0, 0.04, 0.3), (0, 0.06, 0.5)]
    expected += [(1, 0, -0.1), (1, 0.3, 0), (1, 0.4, 0.3), (1, 0.5, 0.45)]
    made = hull_mesh(read(LAYOUTS[layout]))
    assert made.positions == pytest.approx(np.array(expected))
    assert made.faces == [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6]]
    assert made.names[0] == "FP, Keel" and made.names[7] == "station 1, Sheer"


def test_feet_inches_and_eighths():
    made = hull_mesh(read("station (ft),Keel height,WL 1\n0,0-0-0,1-6-4\n3-0-0,-0-1-0,1-6-4+\n"))
    assert made.positions[1] == pytest.approx([0, 18.5 * 0.0254, 0.3048])
    assert made.positions[3] == pytest.approx([3 * 0.3048, (18.5 + 1 / 16) * 0.0254, 0.3048])
    bare = read("station,Keel,WL 1-0-0\n0,0-3-0,1-6-0\n3,0-0-4,2-0-0\n")
    assert bare.points[-1].place == pytest.approx((0.9144, 0.6096, 0.3048)), "no unit is needed"


def test_buttocks_and_waterlines_stand_along_the_section():
    made = hull_mesh(
        read("station (m),Keel,B 0.5,B 1,WL 0.5,WL 1\n0,0,.1,.2,1.4,1.5\n1,0,.6,1.2,.4,.9\n")
    )
    order = [name.split(", ")[1] for name in made.names]
    assert order[:5] == ["Keel", "B 0.5", "B 1", "WL 0.5", "WL 1"]
    assert order[5:] == ["Keel", "WL 0.5", "B 0.5", "WL 1", "B 1"]
    assert all(len(face) in (3, 4) for face in made.faces)


def test_diagonals_are_measured_from_the_middle():
    text = """station (m),x,Keel,Diagonal 1,Diag B,Sheer half-breadth,Sheer height
angle,,,45,30,,
height,,,0.4,0.9,,
0,0,0,0.2,0.4,0.6,1
1,1,0,{0},0.8,0.9,1
"""
    made = hull_mesh(read(text.format(0.5)))
    r = np.sqrt(0.5)
    assert made.positions[5] == pytest.approx([1, 0.5 * r, 0.4 - 0.5 * r])
    assert made.positions[6] == pytest.approx([1, 0.4 * np.sqrt(3), 0.5])
    assert made.names[5:7] == ["station 1, Diagonal 1", "station 1, Diag B"]
    assert [len(face) for face in made.faces] == [4, 4, 4]
    with pytest.raises(OffsetsError, match="Row 1, column 3: Diag 1 needs its angle in a row"):
        read("station (m),Keel,Diag 1\nheight,,1\n0,0,1\n1,0,1\n")


def test_a_raked_transom_has_columns_of_its_places():
    made = hull_mesh(
        read("station (m),x,Keel,WL 0.5,WL 0.5 x,WL 1,WL 1 x\n0,0,0,.1,,.2,\n1,1,0,.5,1.1,.6,1.2\n")
    )
    assert made.positions[:, 0].tolist() == pytest.approx([0, 0, 0, 1, 1.1, 1.2])
    assert made.positions[4:, 1:] == pytest.approx(np.array([(0.5, 0.5), (0.6, 1.0)]))


def test_a_profile_has_places_along_the_hull():
    made = hull_mesh(read("station (m),Keel,WL 0.5,WL 1\nStem,,-0.2,-0.5\n0,0,.1,.2\n1,0,.5,.6\n"))
    assert made.positions[:2] == pytest.approx(np.array([(-0.2, 0, 0.5), (-0.5, 0, 1.0)]))
    assert made.names[0] == "Stem, WL 0.5"


def test_where_a_line_ends_there_is_a_triangle():
    made = hull_mesh(read("station (m),Keel,WL 0,WL 1\n0,0.5,,1\n1,-1,1,2\n2,-1,1,2\n"))
    assert Counter(map(len, made.faces)) == {3: 1, 4: 3}


@pytest.mark.parametrize(
    "text, said",
    [
        ("", "Row 1, column 1: the file has no table"),
        ("hull (mm),1,2\na,1,2\n", "Row 1, column 1: the head begins with 'hull (mm)'"),
        ("station,WL 0\n0,1\n1,2\n", "Row 1, column 1: the file has no table"),
        ("station,Keel,WL 0\n0,1,2\n1,2,3\n", "Row 1, column 1: no unit is named"),
        ("station (mm),Keel,WL 0\n0,1,2\n1,2,3x\n", "Row 3, column 3: '3x' is not a number"),
        ("station (mm),Keel,WL 0\n0,1,2\n1,2,nan\n", "Row 3, column 3: 'nan' is not a number"),
        ("station (mm),Keel,WL 0\n0,1,2\n1,2,3,4\n", "Row 3, column 4: '4' stands right of"),
        ("station (mm),Keel,WL 0\n0,1,2\n0,2,3\n", "Row 3, column 1: there is a second station 0"),
        ("station (mm),Keel,WL 0,WL 0\n0,1,2,3\n1,1,2,3\n", "Row 1, column 4: WL 0 has these"),
        ("station (mm),Keel,300\n0,1,2\n1,1,2\n", "Row 1, column 3: '300' is no name of a line"),
        ("station (mm),Keel,WL\n0,1,2\n1,1,2\n", "Row 1, column 3: WL has no number"),
        ("station (mm),Keel,Sheer\n0,1,2\n1,1,2\n", "Row 1, column 3: 'Sheer' does not say"),
        ("station (mm),Keel,A y,A z\n0,1,2,3\n1,1,2,\n", "Row 3, column 3: A has no height at"),
        ("station (mm),Keel,WL 0\nbow,1,2\n1,2,3\n", "Row 2, column 1: 'bow' is not a number"),
        ("# mm\n\nstation (mm),Keel,WL 0\n0,1,2\n,2,3\n", "Row 5, column 1: this station has no"),
        ("station,line,x (mm),y,z\n0,A,0,1,\n1,A,0,1,2\n", "Row 2, column 5: the point has no"),
        ("station,line,x (mm),y,z\n0,A,0,1,2\n0,A,0,1,2\n", "Row 3, column 2: station 0 has a"),
    ],
)
def test_errors_name_row_and_column(text, said):
    with pytest.raises(OffsetsError) as caught:
        read(text)
    assert said in str(caught.value)


@pytest.mark.parametrize("make", hulls.HULLS)
def test_the_examples_are_the_hulls_as_measured(make):
    hull = make()
    written = (EXAMPLES / hull.file).read_bytes()
    assert written == hulls.text(hull).encode(), "run examples/hulls.py"
    table = read(written.decode())
    found = {(p.station, p.line): 1000.0 * np.array(p.place) for p in table.points}
    assert found.keys() == hull.points.keys()
    off = {key: np.linalg.norm(found[key] - hull.points[key]) for key in found}
    assert {key for key in off if off[key] > 8.0} == hull.wrong.keys()
    made = hull_mesh(table)
    assert len(made.names) == len(made.positions) and set(map(len, made.faces)) <= {3, 4}
    middle = made.positions[np.array(made.creases), 1].max(axis=1) == 0.0
    # stem, sternpost and the keel before it; stem and keel; stem and the keel behind it
    sharp = {"offsets_bulb.csv": 14, "offsets_chine.csv": 12, "offsets_yacht.tsv": 8}
    assert middle.sum() == sharp[hull.file]
    assert (~middle).sum() == (8 if hull.file == "offsets_chine.csv" else 0), "the chine"
