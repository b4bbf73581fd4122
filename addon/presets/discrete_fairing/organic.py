# SPDX-License-Identifier: GPL-3.0-or-later
# Characters, animals, soft things: smooth everywhere, sharp only where an edge is creased.
import bpy

settings = bpy.context.scene.discrete_fairing

settings.energy = "TOTAL_CURVATURE"
settings.interpolation = "EXACT"
settings.boundary = "CURVE"
settings.use_crease_attribute = True
settings.crease_threshold = 0.5
settings.use_sharp_edges = False
settings.use_crease_angle = False
settings.use_corner_angle = False
settings.metric_exponent = 0.5
settings.epsilon = 0.0
settings.shade_smooth = True
