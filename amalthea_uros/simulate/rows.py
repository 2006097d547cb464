"""What the kernel reports: rows of whole numbers, one for each job and for each observation of a chain.

Times are in the time units of the run; a picosecond has a whole number of them.
"""

from __future__ import annotations

from enum import IntEnum


class Job(IntEnum):
    """The columns of a row about a job that has ended, or an execution of a runnable: their numbers follow those of the processes.

    `ACTIVATION`, `START` and `END` are points in time. `RUNNING`, `WAITING`, `POLLING` and `PARKING` are the time in these states
    (BTF state chart); the rest between start and end is the time in the state READY.
    """

    PROCESS = 0
    INSTANCE = 1
    ACTIVATION = 2
    START = 3
    END = 4
    RUNNING = 5
    WAITING = 6
    POLLING = 7
    PARKING = 8
    PREEMPTIONS = 9
    MIGRATIONS = 10


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
