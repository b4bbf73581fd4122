# SPDX-License-Identifier: GPL-3.0-or-later
# Characters, animals, soft things: smooth everywhere, sharp only where an edge is creased.
import bpy

op = bpy.context.active_operator

op.energy = "TOTAL_CURVATURE"
op.interpolation = "EXACT"
op.boundary = "CURVE"
op.use_crease_attribute = True
op.crease_threshold = 0.5
op.use_sharp_edges = False
op.use_crease_angle = False
op.use_corner_angle = False
op.metric_exponent = 0.5
op.shade_smooth = True
