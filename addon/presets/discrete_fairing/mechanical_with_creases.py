# SPDX-License-Identifier: GPL-3.0-or-later
# Machine parts: folds from 30 degrees on are sharp, and sharp curves keep corners from 45 degrees on.
import bpy

settings = bpy.context.scene.discrete_fairing

settings.energy = "TOTAL_CURVATURE"
settings.interpolation = "EXACT"
settings.boundary = "CURVE"
settings.use_crease_attribute = True
settings.crease_threshold = 0.5
settings.use_sharp_edges = True
settings.use_crease_angle = True
settings.crease_angle = 0.523599
settings.use_corner_angle = True
settings.corner_angle = 0.785398
settings.metric_exponent = 0.5
settings.epsilon = 0.0
settings.shade_smooth = True
