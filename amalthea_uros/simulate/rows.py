"""What the kernel reports: rows of whole numbers, one for each job and for each observation of a chain.

Times are in the time units of the run; a picosecond has a whole number of them.
"""

from __future__ import annotations

from enum import IntEnum


class Observation(IntEnum):
    """The columns of a row about a chain, or about an occurrence of something that is watched.

    `STAMP` is the number of the occurrence of the chain's stimulus, counted from 0: its own number for a stimulus; for a response
    that of the newest stimulus whose effect the response shows, or -1 as long as it shows none. An occurrence has the number of its
    source instead of a route, and the number of the core instead of a stamp, or -1.
    """

    ROUTE = 0
    KIND = 1
    TIME = 2
    STAMP = 3


#: The kinds of observations.
STIMULUS, RESPONSE, OCCURRENCE = 0, 1, 2
