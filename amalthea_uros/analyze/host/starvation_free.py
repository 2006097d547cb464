"""Response times in an executor of one thread that calls each ready callback once before it polls again.

After T. Blass, D. Casini, S. Bozhko and B. B. Brandenburg, "A ROS 2 response-time analysis exploiting starvation freedom and
execution-time variance", RTSS 2021. While a job is pending for n polling points, any other callback is called n times at most, and
once more if it comes before the job in a ready set. That counts all releases since the first of them could be pending
(`polling_points`), or those since the begin of the busy window (`busy_window_aware`); neither is always the smaller one. Bounds of the
response times of all callbacks have to be known before; each result can only be smaller, so that results may be used in their turn.

It holds for executors that work off a whole ready set: the single-threaded one, and the static one up to iron. The order in a ready
set is not known from jazzy on, nor across callback groups from galactic on (`owner_less` maps and hash tables of addresses in
rclcpp): then every callback counts as one that comes before.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.response_times.kernel import MAX_STEPS
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask, Supply
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

SOURCE = "Blass, Casini, Bozhko, Brandenburg 2021"


@dataclass(frozen=True, slots=True)
class ReadySet:
    """The callbacks of an executor.

    Attributes
    ----------
    tasks : the callbacks, in the order of the ready set if that is known
    """

    tasks: Sequence[AnalysedTask]
    is_ordered: bool
    supply: Supply = FULL

    def most_calls(self, other: int, index: int, known: Mapping[str, Time]) -> int:
        """How often another callback is called at most while a job of one is pending."""
        task = self.tasks[index]
        return task.events.eta_plus(known[task.name]) + (1 if other < index or not self.is_ordered else 0)


class PendingBound(Protocol):
    """A method: the response time of the callback at an index, which is not above the known one."""

    METHOD: str

    def latest(self, index: int, ready: ReadySet, known: Mapping[str, Time]) -> Time:
        """The response time of a callback if those of all are known."""


def improved(bound: PendingBound, ready: ReadySet, known: Mapping[str, Response]) -> Mapping[str, Response]:
    """The response times of all callbacks of an executor, each the smaller one of a known bound and this one.

    Parameters
    ----------
    known : bounds by name; all of them must be finite
    """
    best = {name: response.worst or 0 for name, response in known.items()}
    for _ in range(MAX_STEPS):
        reached = {task.name: min(best[task.name], bound.latest(index, ready, best)) for index, task in enumerate(ready.tasks)}
        if reached == best:
            break
        best = reached
    return {name: _response_of(response, best[name], bound.METHOD) for name, response in known.items()}


def _response_of(known: Response, worst: Time, method: str) -> Response:
    if worst == known.worst:
        return known
    return Response(worst=worst, best=known.best, method=method, source=SOURCE, claim=Claim.BOUND)
