# SPDX-License-Identifier: GPL-3.0-or-later
# Boats: through every offset, curvature changes as little as possible; marked edges are chines,
# borders keep their corners. The tolerance lets offsets be off.
import bpy

bpy.utils.execfile(__file__.rpartition("Hull")[0] + "Default.py")
op = bpy.context.active_operator

op.energy = "MINIMUM_VARIATION"
op.interpolation = "APPROXIMATE"
op.tolerance = 0.0
op.tolerance_unit = "SCENE"
op.boundary = "CURVE"
op.use_sharp_edges = True
op.use_corner_angle = True
op.corner_angle = 0.785398
