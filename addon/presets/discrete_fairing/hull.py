# SPDX-License-Identifier: GPL-3.0-or-later
# Boats, wings, panels: vertices are stations that a batten may miss by a little; marked edges are chines, borders keep their corners.
import bpy

settings = bpy.context.scene.discrete_fairing

settings.energy = "TOTAL_CURVATURE"
settings.interpolation = "APPROXIMATE"
settings.tolerance = 0.005
settings.boundary = "CURVE"
settings.use_crease_attribute = True
settings.crease_threshold = 0.5
settings.use_sharp_edges = True
settings.use_crease_angle = False
settings.use_corner_angle = True
settings.corner_angle = 0.785398
settings.metric_exponent = 0.5
settings.epsilon = 0.0
settings.shade_smooth = True
