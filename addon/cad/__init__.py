# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair surfaces as spline patches: STEP files and Blender's own NURBS."""
