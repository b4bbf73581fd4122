# SPDX-License-Identifier: GPL-3.0-or-later
"""From curves in space to the control mesh of the surface through them. NumPy, no Blender.

`cubics` (a curve) → `crossings` (where two meet) → `network` (nodes and arcs) → `tangent_planes` →
`cells` (what the arcs enclose) → `counts` (edges an arc) → `control_mesh`. `words` says what did not
take part.
"""
