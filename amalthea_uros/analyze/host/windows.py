"""Latencies in an executor of one thread that calls each ready callback once before it polls again, even if it is overloaded.

After H. Teper, M. Guenzel, N. Ueter, G. von der Brueggen and J.-J. Chen, "End-to-end timing analysis in ROS2", RTSS 2022. From one
poll to the next, each callback is called once at most, so that such a window takes the sum of all execution times at most, whatever
is released. A timer that is due waits for the rest of the present window and is called in the next one: two windows at most. What
takes its message is called in the window after that, and so on. No bound of the load is needed: late timers skip periods.

It holds if nothing preempts the executor, and if each of its callbacks is a timer, or takes the messages of one callback of the
executor that reach it without latency: then one message is pending at each poll at most, and another one can come before it is taken.
The executor must work off whole ready sets, in any order.
"""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.host import HostCallback
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

METHOD = "windows between polls, each callback once"
SOURCE = "Teper, Guenzel, Ueter, von der Brueggen, Chen 2022"
#: A message that was there at the poll, and one that is published before that is taken.
MOST_PENDING = 2


@dataclass(frozen=True, slots=True)
class Windows:
    """The windows of an executor.

    Attributes
    ----------
    length : of each of them at most
    """

    length: Time

    def improved(self, known: Response, route: Sequence[HostCallback]) -> Response:
        """The latency from when the timer of a route is due to the end of its last callback, if it is less than the known one."""
        # The paper has no `- 1`: a timer that is due at a poll is called in the window that begins there, so that it misses a poll by a
        # picosecond at least.
        return self._less(known, (len(route) + 1) * self.length - 1)

    def improved_response(self, known: Response, route: Sequence[HostCallback]) -> Response:
        """The response time of the last callback of a route, from its message on, if it is less than the known one."""
        # What publishes the message is executed in the present window before that, of which all others take the rest, also where it
        # takes less time than it can: the paper counts the whole window.
        before = 1 if len(route) == 1 else route[-2].execution.most or 0
        return self._less(known, 2 * self.length - before)

    def from_any_time(self, route: Sequence[HostCallback]) -> Time:
        """From any time to the end of the last callback of a route whose timer is called at that time or later.

        The timer is due within its period after its last call began. It does not need its execution time twice until the end of the
        next window, unless it is due while it is running.
        """
        timer = route[0]
        cost = timer.execution.most or 0
        return max(timer.period or 0, cost) - cost + (len(route) + 1) * self.length

    def _less(self, known: Response, worst: Time) -> Response:
        if known.worst is not None and known.worst <= worst:
            return known
        return Response(worst=worst, best=known.best, method=METHOD, source=SOURCE, claim=Claim.BOUND)
