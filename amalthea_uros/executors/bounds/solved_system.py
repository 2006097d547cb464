"""What bounds of executors need to know of the rest of the system; the analysis of response times provides it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.event_models.models import EventModel
from amalthea_uros.timing.response import Response
from amalthea_uros.units import Time

#: The method of the bounds of response times.
METHOD = "busy window of the iterations of an executor"


class ThreadProcessor(Protocol):
    """The processor as a thread sees it, with preemption, blocking and suspensions; execution demands are in its time base."""

    @property
    def time_base(self) -> int:
        """Time units per picosecond."""

    def time(self, demand: Time, suspended: Time | None = 0, resumed: int = 1) -> Time | None:
        """The longest time to execute a demand, in picoseconds; None if it is not bounded.

        Parameters
        ----------
        suspended : maximum time of all suspensions; None if it is not known
        resumed : how often it can become ready, the first time included
        """


class SolvedSystem(Protocol):
    """The response times and activations of processes and of messages on wires."""

    @property
    def context(self) -> TimingContext:
        """The timing context of the system."""

    @property
    def event_models(self) -> Mapping[str, EventModel]:
        """Activations, by the names of processes."""

    @property
    def responses(self) -> Mapping[str, Response]:
        """Response times, by the names of processes."""

    @property
    def sent_again(self) -> Mapping[str, EventModel]:
        """How often messages are sent again because some are lost, by their names: all of the controller together."""

    @property
    def reasons(self) -> Mapping[str, str]:
        """Why the response time of a process is unknown."""

    def bcet(self, name: str) -> Time:
        """Best-case execution time of a process, in picoseconds; 0 if it is unknown."""

    def depends_on_losses(self, name: str) -> bool:
        """Whether jobs can be missing in the schedule of a process, because activations are lost."""

    def processor(self, task: str) -> ThreadProcessor:
        """The processor as the thread of a task sees it.

        Raises
        ------
        UnknownError : it is not scheduled, or something unknown can delay it.
        """
