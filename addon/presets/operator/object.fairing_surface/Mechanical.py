# SPDX-License-Identifier: GPL-3.0-or-later
# Machine parts: folds from 30 degrees on are sharp, and sharp curves keep corners from 45 degrees
# on. The tolerance lets vertices be off.
import bpy

bpy.utils.execfile(__file__.rpartition("Mechanical")[0] + "Default.py")
op = bpy.context.active_operator

op.interpolation = "APPROXIMATE"
op.tolerance = 0.0
op.tolerance_unit = "SCENE"
op.boundary = "CURVE"
op.use_sharp_edges = True
op.use_crease_angle = True
op.crease_angle = 0.523599
op.use_corner_angle = True
op.corner_angle = 0.785398
