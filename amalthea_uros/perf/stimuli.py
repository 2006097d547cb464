"""What activates tasks and interrupt service routines."""

from __future__ import annotations

from enum import StrEnum
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.conditions import Condition, ModeAssignment
from amalthea_uros.perf.distributions import Distribution
from amalthea_uros.perf.named import Brief, Named
from amalthea_uros.units import Frequency, Time


@dataclass(frozen=True, slots=True, kw_only=True)
class Arrivals:
    """When messages arrive that do not arrive at exact distances, or not at those that a counter says.

    Attributes
    ----------
    period : nominal distance of two messages; None: as many periods of the process as the counter counts
    jitter : maximum delay of a message; delays do not accumulate
    """

    period: Time | None = None
    jitter: Time = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Counter:
    """Lets only every n-th time take effect; counting goes on across jobs and callers.

    Attributes
    ----------
    prescaler : the n; below 1 it has no meaning
    offset : number of the first effective time, counted from 1; below 1 only its remainder modulo the prescaler counts
    source : the message or timer that the counter represents; counters of a process with the same source take effect together
    is_phase_known : whether the offset is stated; otherwise any time can be the first effective one, and without a source, one time
        more can pass between two effective ones
    arrivals : of the source, if they are not regular: then a job takes what arrived before its activation, and counts nothing
    jitter : number of times by which an effective one can be late, if the phase is unknown
    """

    prescaler: int = 1
    offset: int = 0
    source: str = ""
    is_phase_known: bool = True
    arrivals: Arrivals | None = None
    jitter: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class AbstractStimulus(Named):
    """What all stimuli have.

    Attributes
    ----------
    condition : tested at each occurrence; if it is false, nothing happens
    assignments : modes that are set at each occurrence, before the activations
    """

    condition: Condition | None = None
    assignments: tuple[ModeAssignment, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Periodic(AbstractStimulus):
    """Activation at offset + i * period, shifted by jitter that does not accumulate.

    Attributes
    ----------
    jitter : shift against the ideal grid, possibly negative
    min_distance : least time between two occurrences
    """

    period: Time
    offset: Time = 0
    jitter: Distribution[int] | None = None
    min_distance: Time | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RelativePeriodic(AbstractStimulus):
    """Activation at a varying distance from the one before; also what is called sporadic.

    Attributes
    ----------
    has_maximum : whether the distance has the greatest value of the distribution at most; otherwise it can be longer
    """

    distance: Distribution[int]
    offset: Time = 0
    has_maximum: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Synthetic(AbstractStimulus):
    """Activation at a list of times that is repeated with the period."""

    period: Time
    times: tuple[Time, ...]
    offset: Time = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Burst(AbstractStimulus):
    """Several activations at the start of each period.

    Attributes
    ----------
    length : of a burst; occurrences that would be after it do not happen
    distance : of the occurrences in a burst
    count : occurrences in a burst
    """

    period: Time
    length: Time
    distance: Time = 0
    count: int = 1
    offset: Time = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Single(AbstractStimulus):
    """Activation that happens once."""

    time: Time


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """A clock that drives a variable rate: occurrences where its integral reaches offset + k * recurrence."""

    clock: str
    offset: float = 0.0
    recurrence: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class VariableRate(AbstractStimulus):
    """Activation at a rate that changes.

    Attributes
    ----------
    rate : occurrences in a step of time
    max_increase, max_decrease : how much the rate changes from one step to the next at most; None: any
    scenario : replaces the statistical description
    """

    step: Time
    rate: Distribution[float]
    max_increase: float | None = None
    max_decrease: float | None = None
    scenario: Scenario | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ArrivalCurvePoint:
    """A number of consecutive occurrences and the least and the most time that they span; None: no limit."""

    occurrences: int
    lower: Time | None = None
    upper: Time | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ArrivalCurve(AbstractStimulus):
    """Activation of which only limits are known."""

    points: tuple[ArrivalCurvePoint, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class InterProcess(AbstractStimulus):
    """Activation by triggers that processes execute."""

    counter: Counter | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class EventTriggered(AbstractStimulus):
    """Activation by any of some events."""

    events: tuple[str, ...]
    counter: Counter | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Custom(AbstractStimulus):
    """Activation without meaning to a tool."""

    description: str = ""


Stimulus: TypeAlias = (
    Periodic
    | RelativePeriodic
    | Synthetic
    | Burst
    | Single
    | VariableRate
    | ArrivalCurve
    | InterProcess
    | EventTriggered
    | Custom
)


class Curve(StrEnum):
    """The shape of a varying frequency."""

    SINE = "sine"
    TRIANGLE = "triangle"


@dataclass(frozen=True, slots=True, kw_only=True)
class ClockFunction(Named):
    """A frequency that follows a curve.

    Attributes
    ----------
    lowest : minimum of the curve
    swing : its height
    shift : time at which the rising curve passes the middle
    """

    curve: Curve
    period: Time
    lowest: Frequency
    swing: Frequency
    shift: Time = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class ClockStep:
    """A frequency from a time on."""

    time: Time
    frequency: Frequency


@dataclass(frozen=True, slots=True, kw_only=True)
class ClockSteps(Named):
    """A frequency that changes in steps, which repeat with the period if there is one."""

    steps: tuple[ClockStep, ...]
    period: Time | None = None


Clock: TypeAlias = ClockFunction | ClockSteps


@dataclass(frozen=True, slots=True, kw_only=True)
class Stimuli(Brief):
    """All stimuli of a system, and the clocks that drive some of them."""

    stimuli: tuple[Stimulus, ...] = ()
    clocks: tuple[Clock, ...] = ()
