# SPDX-License-Identifier: GPL-3.0-or-later
"""fair() and Solver for tests of the mathematics: point forces, to 1e-8, measured."""

from functools import partial

import discrete_fairing as df

fair = partial(df.fair, pad_size=0.0, relative_residual=1e-8, measure=True)
Solver = partial(df.Solver, pad_size=0.0, relative_residual=1e-8)
