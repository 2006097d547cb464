"""Logical execution time (LET): a job reads at its release, and its output becomes visible at the end of its period.

This does not depend on the schedule, so that job chains are exact (J. Martinez, I. Sañudo and M. Bertogna, "Analytical characterization
of end-to-end communication delays with logical execution time", IEEE Transactions on CAD 37(11), 2018; computed as in
`job_chains`).
"""

from __future__ import annotations

from math import lcm

import numpy as np

from amalthea_uros.analyze.chains.read_write_times import ReadWriteTimes
from amalthea_uros.units import Time

SOURCE = "Martinez, Sañudo, Bertogna 2018"


def read_write_times(period: Time, offset: Time, cycle: Time) -> ReadWriteTimes:
    """The jobs of a periodic task.

    Parameters
    ----------
    cycle : time after which the whole chain repeats, a multiple of the period
    """
    cycle = lcm(cycle, period)
    until = offset + cycle
    releases = offset + period * np.arange(cycle // period, dtype=np.int64)
    return ReadWriteTimes(releases=releases, reads=releases, writes=releases + period, cycle=cycle, until=until)
