# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender --command discrete_fairing`: files in, files out. The only part of the add-on that touches files."""
