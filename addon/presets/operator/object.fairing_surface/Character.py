# SPDX-License-Identifier: GPL-3.0-or-later
# Characters, animals, soft things: through the points where Subdivision Surface passes, fairer in
# between; sharp only where an edge is creased. Lower spacing and pads than else keep walls straighter.
import bpy

bpy.utils.execfile(__file__.rpartition("Character")[0] + "Default.py")
op = bpy.context.active_operator

op.interpolation = "LIMIT"
op.pad_size = 0.7
op.metric_exponent = 0.45
