"""What an analysis of a system tells."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches
from enum import StrEnum
from fractions import Fraction
from typing import Protocol, SupportsIndex, TypeVar, overload

from amalthea_uros.analyze.chains.result import ChainResult
from amalthea_uros.analyze.task import Response
from amalthea_uros.diagnostics import Finding
from amalthea_uros.units import Frequency, Time


class HasName(Protocol):
    """An object with a name."""

    @property
    def name(self) -> str:
        """The name."""


N = TypeVar("N", bound=HasName)


class Results(tuple[N, ...]):
    """Results in their order, also found by name: `results["Task_5ms"]`."""

    __slots__ = ()

    @overload
    def __getitem__(self, key: SupportsIndex | str) -> N: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[N, ...]: ...
    def __getitem__(self, key: SupportsIndex | str | slice) -> N | tuple[N, ...]:
        """The result with a name, or at an index.

        Raises
        ------
        KeyError : there is none with that name; the text lists near names.
        """
        if not isinstance(key, str):
            return super().__getitem__(key)
        found = next((result for result in self if result.name == key), None)
        if found is None:
            near = get_close_matches(key, self.names, n=3)
            advice = f"did you mean {', '.join(map(repr, near))}?" if near else f"known: {', '.join(self.names) or 'none'}"
            raise KeyError(f"no result named {key!r}; {advice}")
        return found

    @property
    def names(self) -> tuple[str, ...]:
        """The names, in order."""
        return tuple(result.name for result in self)


class Verdict(StrEnum):
    """Whether something that is demanded holds."""

    MET = "met"
    MISSED = "missed"
    UNBOUNDED = "unbounded"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessorResult:
    """A core: its clock, and its load in the best, mean and worst case (1 is full); None if something in it is not known."""

    name: str
    frequency: Frequency | None
    best: Fraction | None
    mean: Fraction | None
    worst: Fraction | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessResult:
    """A task or interrupt service routine.

    Attributes
    ----------
    response : None if it is not known, and then `reason` says why
    distance, gap : the least and the longest time from one activation to the next; None if that is not known
    """

    name: str
    is_isr: bool
    processor: str | None
    priority: int | None
    preemption: str
    bcet: Time | None
    acet: Fraction | None
    wcet: Time | None
    response: Response | None
    deadline: Time | None
    verdict: Verdict
    reason: str = ""
    distance: Time | None = None
    gap: Time | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RequirementResult:
    """A requirement or a constraint with what became of it; the margin is positive if it is met.

    Attributes
    ----------
    limit : None where something else than a time is demanded
    reason : why it is unknown
    """

    name: str
    object: str
    quantity: str
    is_upper: bool
    limit: Time | None
    value: Time | None
    verdict: Verdict
    reason: str = ""

    @property
    def margin(self) -> Time | None:
        """How much is left; negative: how much is too much."""
        if self.value is None or self.limit is None:
            return None
        return self.limit - self.value if self.is_upper else self.value - self.limit


@dataclass(frozen=True, slots=True, kw_only=True)
class Analysis:
    """Everything that was computed.

    Attributes
    ----------
    assumptions : sentences on which the numbers rest
    findings : what could not be taken into account
    """

    processors: Results[ProcessorResult]
    processes: Results[ProcessResult]
    chains: Results[ChainResult]
    requirements: Results[RequirementResult]
    assumptions: tuple[str, ...]
    findings: tuple[Finding, ...]

    def __getitem__(self, process: str) -> ProcessResult:
        """The result of a process by its name.

        Raises
        ------
        KeyError : there is none; the text lists near names.
        """
        return self.processes[process]

    @property
    def misses(self) -> bool:
        """Whether something that is demanded does not hold."""
        verdicts = (*(p.verdict for p in self.processes), *(r.verdict for r in self.requirements))
        return any(verdict in (Verdict.MISSED, Verdict.UNBOUNDED) for verdict in verdicts)
