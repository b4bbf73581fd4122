# SPDX-License-Identifier: GPL-3.0-or-later
# Bonnets, doors, wings: through the points where Subdivision Surface passes, so that nothing swings
# beside a row, and fairer in between; marked edges are sharp, borders keep corners and ends.
import bpy

bpy.utils.execfile(__file__.rpartition("Panel")[0] + "Default.py")
op = bpy.context.active_operator

op.interpolation = "LIMIT"
op.tolerance = 0.0
op.tolerance_unit = "SCENE"
op.use_sharp_edges = True
op.corner_angle = 0.785398
