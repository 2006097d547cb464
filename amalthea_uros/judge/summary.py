"""The verdict on a whole system: whether everything that was judged is met, and what fails or is unknown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import StrEnum
from fractions import Fraction
from math import inf
from typing import Generic, Protocol, TypeVar

from amalthea_uros._internal.records import dataclass
from amalthea_uros.judge.causes import Failing, FailureCause, causes, processes_of, quantity_of
from amalthea_uros.judge.margins import Limited, share_left, tightest
from amalthea_uros.judge.verdict import FAILURES, WORST_FIRST, Verdict
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.demand.quantiles import quantile_condition


class JudgedItem(Limited, Failing, Protocol):
    """A process with its deadline, a requirement or a constraint, with the verdict on it."""

    @property
    def name(self) -> str:
        """Of the process, the requirement or the constraint."""

    @property
    def margin(self) -> int | None:
        """Distance of the value from the limit; negative if the limit is missed."""

    @property
    def verdict(self) -> Verdict | None:
        """None if nothing was judged."""

    @property
    def reason(self) -> str:
        """Why it is not met."""


class LoadedCore(Protocol):
    """A core with its load."""

    @property
    def name(self) -> str:
        """Of the core."""

    @property
    def is_overloaded(self) -> bool:
        """Whether it has more work than it can execute."""


class Schedulable(StrEnum):
    """Whether all deadlines, requirements and constraints are met, no activation is lost, and no core is overloaded."""

    YES = "yes"
    NO = "no"
    UNKNOWN = "unknown"


def urgency(item: JudgedItem) -> tuple[int, Fraction | float]:
    """Sorts the worst first: what fails, what is unknown, then what has the smallest share of its limit left."""
    share = share_left(item)
    return WORST_FIRST.index(item.verdict), inf if share is None else share


J = TypeVar("J", bound=JudgedItem)
C = TypeVar("C", bound=LoadedCore)


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary(Generic[J, C]):
    """The verdicts on a system, counted.

    Attributes
    ----------
    judged : number of processes, requirements and constraints with a verdict
    failing, unknown : those that are not met for certain, and those about which it is unknown
    overloaded : the cores with more work than they can execute, as far as no process on them shows it
    causes : the failures by their root causes, each once
    tightest : the one that is met with the smallest share of its limit left; None if there is none
    condition : under which what is met is met, although it need not always hold; "" if there is none
    """

    judged: int
    failing: tuple[J, ...]
    unknown: tuple[J, ...]
    overloaded: tuple[C, ...]
    causes: tuple[FailureCause[J, C], ...]
    tightest: J | None
    condition: str = ""

    @property
    def schedulable(self) -> Schedulable:
        """Yes only if something was judged, and all of it is met."""
        if self.failing or self.overloaded:
            return Schedulable.NO
        return Schedulable.UNKNOWN if self.unknown or not self.judged else Schedulable.YES

    @property
    def unexplained(self) -> tuple[J, ...]:
        """What is unknown for another reason than a failure."""
        consequences = {quantity_of(item) for cause in self.causes for item in cause.consequences}
        return tuple(item for item in self.unknown if quantity_of(item) not in consequences)

    @property
    def missed(self) -> int:
        """Number of verdicts that are failures, and of overloaded cores that no verdict shows."""
        return len(self.failing) + len(self.overloaded)


def summarize(cores: Iterable[C], judged: Sequence[J], context: TimingContext) -> Summary[J, C]:
    """The summary of results; those without a verdict do not count."""
    failing = tuple(item for item in judged if item.verdict in FAILURES)
    unknown = tuple(item for item in judged if item.verdict is Verdict.UNKNOWN)
    shown = {core for item in judged if (core := item.overloaded_core) is not None}
    overloaded = tuple(core for core in cores if core.is_overloaded and core.name not in shown)
    return Summary(
        judged=sum(item.verdict is not None for item in judged),
        failing=failing,
        unknown=unknown,
        overloaded=overloaded,
        causes=causes(overloaded, failing, unknown, lambda limit: processes_of(limit, context)),
        tightest=tightest(item for item in judged if item.verdict is Verdict.MET),
        condition="" if context.settings.quantile is None else quantile_condition(context.settings.quantile),
    )
