# SPDX-License-Identifier: GPL-3.0-or-later
"""The error of a call that is refused."""

import discrete_fairing as df
import pytest


def refusal(call, *arguments, **options) -> df.FairingError:
    """The error that a call raises."""
    with pytest.raises(df.FairingError) as caught:
        call(*arguments, **options)
    return caught.value
