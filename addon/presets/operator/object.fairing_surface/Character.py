# SPDX-License-Identifier: GPL-3.0-or-later
# Characters, animals, soft things: through the points where Subdivision Surface passes, fairer in
# between; sharp only where an edge is creased. Lower spacing and pads than else keep walls straighter.
import bpy

op = bpy.context.active_operator

op.levels = 3
op.energy = "THIN_PLATE"
op.interpolation = "LIMIT"
op.limit = 1.0
op.tolerance = 0.02
op.tolerance_unit = "RELATIVE"
op.pad_size = 0.7
op.tension = 0.0
op.boundary = "CORNERS"
op.mesh_source = "ORIGINAL"
op.joint = "TANGENT"
op.keep_symmetry = True
op.use_crease_attribute = True
op.crease_threshold = 1.0
op.use_sharp_edges = False
op.use_crease_angle = False
op.crease_angle = 0.698132
op.use_corner_angle = False
op.corner_angle = 1.047198
op.metric_exponent = 0.45
op.repair = "MEND"
op.weld = 0.0
op.use_shape_keys = True
op.copy_modifiers = False
op.hide_source = True
op.shade_smooth = True
