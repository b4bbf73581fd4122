# SPDX-License-Identifier: GPL-3.0-or-later
"""fair() and Solver as tests of the mathematics want them: on point forces, solved to 1e-8 and
measured, unless a test says otherwise. (The defaults stop where nothing is left to see.)"""

from functools import partial

import discrete_fairing as df

fair = partial(df.fair, pad_size=0.0, relative_residual=1e-8, measure=True)
Solver = partial(df.Solver, pad_size=0.0, relative_residual=1e-8)
