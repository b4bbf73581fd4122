# SPDX-License-Identifier: GPL-3.0-or-later
"""To CAD: fair surfaces as spline patches, as STEP files and as Blender's own NURBS."""
