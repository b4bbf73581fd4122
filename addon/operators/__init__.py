# SPDX-License-Identifier: GPL-3.0-or-later
"""Every button: what users and scripts call."""
