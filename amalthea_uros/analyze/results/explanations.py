"""What results consist of: response times of processes and callbacks, and latencies of chains."""

from __future__ import annotations

from enum import StrEnum
from fractions import Fraction

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.results.chains import ChainResult, LatencyQuantity, LatencyValue
from amalthea_uros.analyze.results.processes import CallbackResult, ProcessResult, RequirementResult
from amalthea_uros.executors.results import HandleResult
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class ExecutionShare:
    """The share of a runnable, or of something else that a job executes, in the worst-case execution time of a process.

    Attributes
    ----------
    name : of the runnable, or what else it is
    is_runnable : whether it is a runnable
    calls : how often it is called
    counter : if only some jobs execute it
    time : in a job that executes it; None if it is unknown, for the `reason`
    """

    name: str
    is_runnable: bool
    time: Time | None
    calls: int = 1
    counter: Counter | None = None
    reason: str = ""


class OriginKind(StrEnum):
    """What is missing."""

    MAPPING = "mapping"
    DEMAND = "demand"
    ACTIVATION = "activation"
    OVERLOAD = "overload"
    OTHER = "other"


@dataclass(frozen=True, slots=True, kw_only=True)
class Origin:
    """A process from which it comes that a response time has no bound.

    Attributes
    ----------
    remedy : what would give it a bound, as an imperative; "" if there is no general advice
    """

    process: str
    kind: OriginKind
    reason: str
    remedy: str


@dataclass(frozen=True, slots=True)
class Share:
    """The share of one process in the interference: number of jobs, and their time in picoseconds."""

    name: str
    jobs: int
    time: Time


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """The part of the core, or of the budget of a server, that something needs in the long run; None if it is unknown."""

    name: str
    priority: int | None
    utilisation: Fraction | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessExplanation:
    """What the response time of a process consists of.

    Attributes
    ----------
    execution : shares in its worst-case execution time
    shares : in the interference, largest first
    loads : if its deadline is not met, or it is unknown whether it is: of itself and of all that is served before it or in turn
        with it, largest first
    supply : the part of the core that is there for them: less than 1 in a server
    callbacks : that its jobs call, in order
    worst_job : number of the job with the worst-case response time; None if it is unknown
    in_worst_job : for each share of `execution`, whether that job executes it; empty if the job is unknown
    origins : if its response time has no bound: where that comes from
    """

    process: ProcessResult
    execution: tuple[ExecutionShare, ...]
    shares: tuple[Share, ...]
    loads: tuple[Load, ...] = ()
    supply: Fraction = Fraction(1)
    callbacks: tuple[CallbackResult, ...] = ()
    worst_job: int | None = None
    in_worst_job: tuple[bool, ...] = ()
    origins: tuple[Origin, ...] = ()

    @property
    def load(self) -> Fraction | None:
        """The sum of the loads; None if one is unknown."""
        known = [load.utilisation for load in self.loads if load.utilisation is not None]
        return sum(known, Fraction(0)) if len(known) == len(self.loads) else None


@dataclass(frozen=True, slots=True, kw_only=True)
class CallbackExplanation:
    """What the response time of a callback consists of.

    Attributes
    ----------
    process : whose jobs call it
    execution : what these jobs execute up to the callback, in order, with the callback itself last
    handles : in an executor that spins in a loop, the handles that call it; their terms take the response time apart
    """

    callback: CallbackResult
    process: ProcessResult
    execution: tuple[ExecutionShare, ...]
    handles: tuple[HandleResult, ...] = ()


class CauseKind(StrEnum):
    """Why a part of a latency takes its time.

    Attributes
    ----------
    JUST_MISSED : the input arrives just after the previous job has read
    NEXT_JOB : the next job that takes part is released later
    INTERFERENCE : jobs of another process execute before the job reads
    PREEMPTION : jobs of another process execute between its read and its output
    EXECUTION : the job itself executes
    LOGICAL : the output is published at the end of the period (LET)
    FULL_PERIOD : the bound assumes that a whole period passes until the next job
    READ_DELAY : from the release to the read, at least the sum of what is known only as bounds
    RESPONSE : from the earliest read to the latest output: the response time, with all interference and blocking
    TRIGGERED : the response time of a process that another one triggers
    """

    JUST_MISSED = "just_missed"
    NEXT_JOB = "next_job"
    INTERFERENCE = "interference"
    PREEMPTION = "preemption"
    EXECUTION = "execution"
    LOGICAL = "logical"
    FULL_PERIOD = "full_period"
    READ_DELAY = "read_delay"
    RESPONSE = "response"
    TRIGGERED = "triggered"


@dataclass(frozen=True, slots=True, kw_only=True)
class LatencyCause:
    """Why a part of a hop takes its time.

    Attributes
    ----------
    process : that interferes, "" for other kinds
    jobs : number of its jobs
    terms : of a response time, if that is all of it
    """

    kind: CauseKind
    time: Time
    process: str = ""
    jobs: int = 0
    terms: tuple[tuple[str, Time], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Execution:
    """A part of a job that a core executes without interruption.

    Attributes
    ----------
    job : its number, counted from 1 at the start of the system
    """

    core: str
    process: str
    job: int
    begin: Time
    end: Time


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
    wait: Time
    run: Time
    job: int | None = None
    release: Time | None = None
    start: Time | None = None
    read: Time = 0
    write: Time = 0
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
