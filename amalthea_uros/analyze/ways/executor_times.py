"""What the ways need to know of executors that loop; the results of their analysis have it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, TypeVar

from amalthea_uros.analyze.solution import Solution
from amalthea_uros.perf.network import Span
from amalthea_uros.units import Time


class Bounds(Protocol):
    """The bounds of a response time; `worst` is None if there is none, for the `reason`."""

    @property
    def best(self) -> Time:
        """Minimum."""

    @property
    def worst(self) -> Time | None:
        """Maximum."""

    @property
    def reason(self) -> str:
        """Why there is none."""


class TermTimes(Protocol):
    """A term of a response time."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def least(self) -> Time:
        """In the best case."""

    @property
    def most(self) -> Time | None:
        """In the worst case."""

    @property
    def why(self) -> str:
        """What it consists of."""


class HandleTimes(Protocol):
    """A handle of an executor.

    Attributes
    ----------
    response : from the arrival of a message, or from when a timer is due, to the end of its callback; None if it is unknown
    lost : how messages or periods can be lost; None if none can
    """

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def response(self) -> Bounds | None:
        """Its response time."""

    @property
    def lost(self) -> object | None:
        """What can be lost."""

    @property
    def terms(self) -> Sequence[TermTimes]:
        """The parts of the worst response time."""


class ExecutorTimes(Protocol):
    """An executor that loops."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def handles(self) -> Sequence[HandleTimes]:
        """Its handles."""


Executors = TypeVar("Executors", bound=ExecutorTimes, covariant=True)


class ExecutorEvaluation(Protocol[Executors]):
    """The analysis of all executors that loop."""

    def __call__(
        self, solution: Solution, *, sending: Mapping[str, Span], extra_jitter: Mapping[str, Time | None]
    ) -> Sequence[Executors]:
        """The results of all executors.

        Parameters
        ----------
        sending : how long a callback waits for a message that it sends, by the names of transmissions
        extra_jitter : how far the arrivals of messages vary besides the jitter of the handle, by the names of handles; None: unknown
        """
        ...
