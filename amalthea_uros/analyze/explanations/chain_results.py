"""The maximum latency of a chain as the hops that it consists of."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros.analyze.explanations.hop_causes import Execution, LatencyCause
from amalthea_uros.analyze.results.chains import ChainResult, LatencyQuantity, LatencyValue
from amalthea_uros.analyze.results.requirements import RequirementResult
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessHop:
    """The contribution of a process to a latency; times are relative to the first read.

    Attributes
    ----------
    job : its number, counted from 1 at the start of the system; None if the value is not based on single jobs
    release, start : of the job; None if they are unknown
    read, write : when it reads, and when its output is visible
    wait, run : from the previous output (or the beginning) to the read, and from the read to the output
    core : that executes it; None if it is unknown
    period : time from one job that takes part to the next one, at most; None if it is unknown
    one_in : of so many jobs of the process, one takes part
    wait_causes, run_causes : why wait and run take their time; they add up to them
    executions : of it and of those that interfere; empty if they are not the same in each such worst case
    """

    process: str
    job: int | None
    release: Time | None
    start: Time | None
    read: Time
    write: Time
    wait: Time
    run: Time
    core: str | None = None
    period: Time | None = None
    one_in: int = 1
    wait_causes: tuple[LatencyCause, ...] = ()
    run_causes: tuple[LatencyCause, ...] = ()
    executions: tuple[Execution, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainExplanation:
    """A maximum latency of a chain.

    Attributes
    ----------
    value : that is explained; None if there is none, for the `reason`
    route : the events and the links between them
    hops : of a chain without message hops: their waits and runs, with `overwritten`, add up to the value; empty for the `reason`
    overwritten : for data age, the time from the last output until the next one
    requirements : the verdicts on limits of the chain
    """

    chain: ChainResult
    quantity: LatencyQuantity
    value: LatencyValue | None = None
    route: str = ""
    hops: tuple[ProcessHop, ...] = ()
    overwritten: Time = 0
    reason: str = ""
    requirements: tuple[RequirementResult, ...] = ()

    def share(self, time: Time) -> Fraction:
        """The part of the value that a time is."""
        whole = self.value.value if self.value is not None else None
        return Fraction(time, whole) if whole else Fraction(0)
