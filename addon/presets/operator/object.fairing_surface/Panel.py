# SPDX-License-Identifier: GPL-3.0-or-later
# Bonnets, doors, wings: through the points where Subdivision Surface passes, so that nothing swings
# beside a row, and fairer in between; marked edges are sharp, borders keep corners and ends.
import bpy

op = bpy.context.active_operator

op.levels = 3
op.energy = "THIN_PLATE"
op.interpolation = "LIMIT"
op.limit = 1.0
op.tolerance = 0.0
op.tolerance_unit = "SCENE"
op.pad_size = 1.0
op.tension = 0.0
op.boundary = "CORNERS"
op.mesh_source = "ORIGINAL"
op.joint = "TANGENT"
op.keep_symmetry = True
op.use_crease_attribute = True
op.crease_threshold = 1.0
op.use_sharp_edges = True
op.use_crease_angle = False
op.crease_angle = 0.698132
op.use_corner_angle = False
op.corner_angle = 0.785398
op.metric_exponent = 0.5
op.repair = "MEND"
op.weld = 0.0
op.use_shape_keys = True
op.copy_modifiers = False
op.hide_source = True
op.shade_smooth = True
