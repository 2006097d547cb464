"""The smallest step of the time stamps of a trace."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros.units import Time

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: From fewer different distances, no step can be concluded.
_ENOUGH = 20


def resolution_of(times: NDArray[np.int64], stated: Time | None = None) -> Time | None:
    """The step of which all times are multiples, at least the stated one; None if it is not known.

    Parameters
    ----------
    stated : the step in which the format writes times; the clock may have a larger one
    """
    import numpy as np

    steps = np.unique(np.abs(np.diff(times)))
    if np.count_nonzero(steps) < _ENOUGH:
        return stated
    return max(int(np.gcd.reduce(steps)), stated or 0)
