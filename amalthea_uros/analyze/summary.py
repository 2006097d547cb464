"""The verdict on a whole system: whether everything that was judged is met, and what fails or is unknown."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from amalthea_uros.analyze.results import ProcessorResult, ProcessResult, RequirementResult
from amalthea_uros.analyze.verdicts import Failure, Verdict

FAILURES = (Verdict.MISSED, Verdict.UNBOUNDED)

Judged = ProcessResult | RequirementResult


class Schedulable(StrEnum):
    """Whether all deadlines, requirements and constraints are met, no activation is lost, and no core is overloaded."""

    YES = "yes"
    NO = "no"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """The verdicts on a system, counted.

    Attributes
    ----------
    judged : number of processes, requirements and constraints with a verdict
    failing, unknown : those that are not met for certain, and those about which it is unknown
    overloaded : the cores with more work than they can execute, as far as no process on them shows it
    tightest : the one that is met with the least margin; None if there is none
    """

    judged: int
    failing: tuple[Judged, ...]
    unknown: tuple[Judged, ...]
    overloaded: tuple[ProcessorResult, ...]
    tightest: Judged | None

    @property
    def schedulable(self) -> Schedulable:
        """Yes only if something was judged, and all of it is met."""
        if self.failing or self.overloaded:
            return Schedulable.NO
        return Schedulable.UNKNOWN if self.unknown or not self.judged else Schedulable.YES

    @property
    def missed(self) -> int:
        """Number of failures."""
        return len(self.failing) + len(self.overloaded)


def summarize(
    processors: Iterable[ProcessorResult], processes: Iterable[ProcessResult], requirements: Iterable[RequirementResult]
) -> Summary:
    """The summary of results."""
    judged: list[Judged] = [*(process for process in processes if process.verdict is not None), *requirements]
    met = [(margin, item) for item in judged if item.verdict is Verdict.MET and (margin := item.margin) is not None]
    failing = tuple(item for item in judged if item.verdict in FAILURES)
    shown = {item.processor for item in failing if isinstance(item, ProcessResult) and item.failure is Failure.OVERLOAD}
    return Summary(
        judged=len(judged),
        failing=failing,
        unknown=tuple(item for item in judged if item.verdict is Verdict.UNKNOWN),
        overloaded=tuple(core for core in processors if core.is_overloaded and core.name not in shown),
        tightest=min(met, key=lambda pair: pair[0], default=(None, None))[1],
    )
