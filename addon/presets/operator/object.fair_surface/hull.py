# SPDX-License-Identifier: GPL-3.0-or-later
# Boats, wings, panels: vertices are stations that a batten may miss by a little; marked edges are chines, borders keep their corners.
import bpy

op = bpy.context.active_operator

op.energy = "TOTAL_CURVATURE"
op.interpolation = "APPROXIMATE"
op.tolerance = 0.005
op.boundary = "CURVE"
op.use_crease_attribute = True
op.crease_threshold = 0.5
op.use_sharp_edges = True
op.use_crease_angle = False
op.use_corner_angle = True
op.corner_angle = 0.785398
op.metric_exponent = 0.5
op.shade_smooth = True
