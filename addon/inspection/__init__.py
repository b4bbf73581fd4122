# SPDX-License-Identifier: GPL-3.0-or-later
"""How fair a surface is: stripes, curvature colours, numbers."""
