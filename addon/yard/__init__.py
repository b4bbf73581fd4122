# SPDX-License-Identifier: GPL-3.0-or-later
"""Tools of a boat yard: reads offsets; makes closed hulls, sections, plans and hydrostatics."""
