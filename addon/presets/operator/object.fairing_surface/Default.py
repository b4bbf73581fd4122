# SPDX-License-Identifier: GPL-3.0-or-later
# The settings of a new file: through every vertex, on pads.
import bpy

op = bpy.context.active_operator

op.levels = 3
op.energy = "THIN_PLATE"
op.interpolation = "AUTO"
op.limit = 1.0
op.tolerance = 0.02
op.tolerance_unit = "RELATIVE"
op.pad_size = 1.0
op.tension = 0.0
op.boundary = "CORNERS"
op.mesh_source = "ORIGINAL"
op.joint = "TANGENT"
op.use_crease_attribute = True
op.crease_threshold = 1.0
op.use_sharp_edges = False
op.use_crease_angle = False
op.crease_angle = 0.698132
op.use_corner_angle = False
op.corner_angle = 1.047198
op.metric_exponent = 0.5
op.repair = "MEND"
op.weld = 0.0
op.use_shape_keys = True
op.copy_modifiers = False
op.hide_source = True
op.shade_smooth = True
