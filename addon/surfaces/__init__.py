# SPDX-License-Identifier: GPL-3.0-or-later
"""The ties of a surface to other objects: its place beside the source, neighbours at borders and the normals there,
curves over which its cage is made, and changes since it was made.
"""
