# SPDX-License-Identifier: GPL-3.0-or-later
"""What a boat yard sends and wants: offsets in; closed hulls, sections, plans and hydrostatics out."""
