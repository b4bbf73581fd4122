# SPDX-License-Identifier: GPL-3.0-or-later
"""Inspects the fairness of a surface: stripes, curvature colours, numbers."""
