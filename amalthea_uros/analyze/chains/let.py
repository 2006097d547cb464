"""Logical execution times: a job reads at its release, and what it writes can be read at the end of its period.

No schedule changes that, so that following the jobs is exact (J. Martinez, I. Sañudo and M. Bertogna, "Analytical characterization
of end-to-end communication delays with logical execution time", IEEE Transactions on CAD 37(11), 2018; the formula is that of
`job_chains`).
"""

from __future__ import annotations

from math import lcm

import numpy as np

from amalthea_uros.analyze.chains.job_times import ReadWriteTimes
from amalthea_uros.units import Time

SOURCE = "Martinez, Sañudo, Bertogna 2018"


def track(period: Time, offset: Time, cycle: Time) -> ReadWriteTimes:
    """The jobs of a periodic task.

    Parameters
    ----------
    cycle : time after which everything repeats, a multiple of the period
    """
    cycle = lcm(cycle, period)
    until = offset + cycle
    releases = offset + period * np.arange(cycle // period, dtype=np.int64)
    return ReadWriteTimes(releases=releases, reads=releases, writes=releases + period, cycle=cycle, until=until)
