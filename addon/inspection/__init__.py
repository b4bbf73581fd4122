# SPDX-License-Identifier: GPL-3.0-or-later
"""How fair is it? Zebra stripes, curvature colours and numbers, on any mesh object."""
