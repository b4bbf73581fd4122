# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be set, its layout and its presets."""
