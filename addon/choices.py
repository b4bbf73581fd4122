# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of settings with a choice: identifier, name in the interface, description."""

# a choice a line, so that each table reads as one
# fmt: off

# for the operator, the panel and the command line
DEFAULT_ENERGY = "THIN_PLATE"
ENERGY_MEANING = "What is minimized: bending, total curvature, or the change of curvature"

# numbered, because files keep the number
ENERGIES = (
    ("THIN_PLATE", "Bending",
     "Bends as little as a thin sheet of spring steel, and is a little flat between the vertices", 0),
    ("TOTAL_CURVATURE", "Curvature", "The least total curvature: vertices on a sphere give the sphere", 1),
    ("MINIMUM_VARIATION", "Flow Lines",
     "Curvature changes as little as possible along the surface, so that reflections are even", 2),
)

ENERGY_NAMES = {key: name for key, name, *_ in ENERGIES}

# short enough for the panel; the prediction states the cost
ENERGY_MEANINGS = {
    "THIN_PLATE": "A little flat between vertices",
    "TOTAL_CURVATURE": "Roundest: spheres stay spheres",
    "MINIMUM_VARIATION": "Most even reflections",
}

# numbered, because files keep the number
INTERPOLATIONS = (
    ("AUTO", "Auto",
     "Limit under a Subdivision Surface modifier, and for sharp hollows or slits; Flats for bevelled bodies; else Through", 3),
    ("EXACT", "Through", "The surface passes exactly through every vertex of the source", 0),
    ("FLATS", "Flats",
     "Through every vertex, and large flat faces and walls between tight rims stay flat, as those of a phone or a can", 4),
    ("APPROXIMATE", "Near",
     "Bends as little as the tolerance of each vertex allows; for scattered or wrong points use Ease Control Mesh", 1),
    ("LIMIT", "Limit",
     "The surface passes where Subdivision Surface would, for cages that were modelled under that modifier", 2),
)

INTERPOLATION_NAMES = {key: name for key, name, *_ in INTERPOLATIONS}

TOLERANCE_UNITS = (
    ("RELATIVE", "Share of Edges", "As a share of the mean edge length of the control mesh, whatever its size", 0),
    ("SCENE", "Length", "As a length in scene units", 1),
)

REPAIRS = (
    ("MEND", "Mend", "Fairs a copy without defects, such as duplicate faces, and says what was done; the source stays"),
    ("REFUSE", "Refuse", "Fairs no mesh that has such defects, and says where they are"),
)

# numbered, because files keep the number
BOUNDARIES = (
    ("CORNERS", "Keep Corners",
     "Borders become smooth curves through their vertices, with corners where the sheet turns by over 60°", 3),
    ("CURVE", "Smooth", "Open borders become smooth curves through their own vertices, around corners too", 0),
    ("LINEAR", "Straight", "Open borders keep the straight edges of the source", 1),
    ("FREE", "Free", "Open borders follow the surface and are fixed only at their vertices", 2),
)

# of single border edges, numbered like their attribute (mesh/marks.py)
EDGE_BOUNDARIES = (
    ("CURVE", "Smooth", "Part of a smooth curve through the vertices of the border", 1),
    ("LINEAR", "Straight", "The edge stays straight", 2),
    ("FREE", "Free", "Between its vertices the edge follows the surface", 3),
    ("SURFACE", "As the Surface", "As the setting Boundary of the whole surface", 0),
)

# the plane of symmetry of half a mesh, in the object's coordinates
SYMMETRY_PLANES = (
    ("NONE", "None", "The mesh is complete"),
    ("X", "X", "The border in the plane x = 0 meets the mirror image of the mesh without a joint"),
    ("Y", "Y", "The border in the plane y = 0 meets the mirror image of the mesh without a joint"),
    ("Z", "Z", "The border in the plane z = 0 meets the mirror image of the mesh without a joint"),
)

MESH_SOURCES = (
    ("ORIGINAL", "As Modelled", "The mesh itself, as Edit Mode shows it"),
    ("EVALUATED", "With Modifiers", "The result of the source's modifiers"),
)

JOINTS = (
    ("POSITION", "Touching", "The surface meets the rest without a gap, at any angle (G0)"),
    ("TANGENT", "Tangent", "The surface leaves the rest in the direction of the neighbouring faces (G1)"),
    ("CURVATURE", "Curvature",
     "As Tangent, and the surface begins to bend gently, so that reflections flow across (like G2)"),
)

# by operator
FILL_JOINTS = (
    *JOINTS,
    ("FLAT", "Flat", "Flat faces without new vertices, and a sharp rim: for caps and transoms"),
)

EASE_AMOUNTS = (
    ("AUTOMATIC", "Automatic", "Removes the scatter and keeps the shape: the amount is estimated from the vertices"),
    ("TOLERANCE", "Within Tolerance", "As fair as possible, with no vertex moved farther than the tolerance"),
    ("STIFFNESS", "Stiffness",
     "Like a batten: the stiffer, the more all vertices move, scatter first and then the shape"),
    ("WORST", "Worst Vertices", "Only the most strained, each to the surface through the others"),
)

STRAINED = (
    ("FLOOR", "Outliers", "Vertices whose strain exceeds the scatter and that of their neighbours"),
    ("COUNT", "The Worst", "So many"),
)

FIT_AMOUNTS = (
    ("AUTO", "Automatic", "As closely as the noise of the scan allows"),
    ("TOLERANCE", "Within Tolerance", "The calmest surface with 95 % of the scan within it"),
)

VERTICES_IN_PLACE = (
    ("FREE", "Free", "They move to the fairest surface, wherever they were: for bumps and holes"),
    ("MEASURED", "Measured", "They are noisy data: they move to a surface near them, except at edges marked sharp"),
)

JOINTS_IN_PLACE = (
    ("POSITION", "Touching", "Only the rim of the selection is held: any angle there (G0)"),
    ("TANGENT", "Tangent", "The selection continues the direction of the faces around it (G1)"),
    ("CURVATURE", "Curvature", "The selection continues the curvature of the faces around it (like G2)"),
)

SECTION_PLANES = (
    ("STATIONS", "Stations", "Across X: at the stations of the imported table, else evenly spaced"),
    ("BUTTOCKS", "Buttocks", "Across Y"),
    ("WATERLINES", "Waterlines", "Across Z"),
    ("DIAGONALS", "Diagonals", "Along X, tilted outwards and down from the middle"),
    ("OBJECT", "Plane of an Object", "Across the Z axis of the other selected object"),
)

OFFSET_UNITS = (
    ("AUTO", "As in the File", "The unit that the file names"),
    ("mm", "Millimetres", "All numbers are in millimetres"),
    ("cm", "Centimetres", "All numbers are in centimetres"),
    ("m", "Metres", "All numbers are in metres"),
    ("in", "Inches", "All numbers are in inches"),
    ("ft", "Feet", "All numbers are in feet; 3-4-5 are feet, inches and eighths"),
)

# of the display of objects
STRIPES_FIXED_TO = (
    ("VIEW", "View", "The tubes stand around you: turn the view, and the stripes run over the surface"),
    ("OBJECT", "Object", "The tubes stand around the object, like lamps in a showroom, and turn with it"),
)

SECTION_AXES = (
    ("X", "X", "Planes across the object's x axis"),
    ("Y", "Y", "Planes across the object's y axis"),
    ("Z", "Z", "Planes across the object's z axis"),
)
