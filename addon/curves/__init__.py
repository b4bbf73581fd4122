# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the control mesh of the surface through curves in space. NumPy, no Blender.

`cubics` (a curve) → `crossings` (where two meet) → `network` (nodes and arcs) → `tangent_planes` →
`cells` (regions between arcs) → `control_mesh` (edges on an arc, and grids) → `settle`, which reports the
parts that were left out; `chains` follows edges.
"""
