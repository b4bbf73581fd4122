# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with a mesh, and how to mend it."""
