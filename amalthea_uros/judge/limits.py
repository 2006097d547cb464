"""All limits of a system, listed once for everybody who asks whether they are kept."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.perf.constraints import (
    Bound,
    ChainSynchronization,
    Constraint,
    DataAgeConstraint,
    DelayConstraint,
    EventSynchronization,
    JitterLimit,
    LatencyConstraint,
    LatencyKind,
    OrderConstraint,
    RepetitionConstraint,
    Requirement,
    TimeLimit,
    TimeMetric,
)
from amalthea_uros.perf.named import Named
from amalthea_uros.perf.software import Process, Task
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import activation_period, implicit_deadline, response_time_limits
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric, is_deviation_from_period, jitter_name
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.units import Time

#: A constraint that is about occurrences.
EventConstraint: TypeAlias = Constraint | DataAgeConstraint | OrderConstraint
#: What states limits in a system.
Stated: TypeAlias = Requirement | EventConstraint

#: The metrics of jobs by the names that requirements have for them.
JOB_METRICS = {
    TimeMetric.RESPONSE_TIME: JobMetric.RESPONSE_TIME,
    TimeMetric.NET_EXECUTION_TIME: JobMetric.NET_EXECUTION_TIME,
    TimeMetric.GROSS_EXECUTION_TIME: JobMetric.GROSS_EXECUTION_TIME,
    TimeMetric.RUNNING_TIME: JobMetric.RUNNING_TIME,
    # On one core: it is the running time unless jobs migrate.
    TimeMetric.CORE_EXECUTION_TIME: JobMetric.RUNNING_TIME,
    TimeMetric.READY_TIME: JobMetric.READY_TIME,
    TimeMetric.WAITING_TIME: JobMetric.WAITING_TIME,
    TimeMetric.POLLING_TIME: JobMetric.POLLING_TIME,
    TimeMetric.PARKING_TIME: JobMetric.PARKING_TIME,
    TimeMetric.START_DELAY: JobMetric.INITIAL_PENDING_TIME,
    TimeMetric.LATENESS: JobMetric.LATENESS,
    TimeMetric.ACTIVATE_TO_ACTIVATE: JobMetric.ACTIVATE_TO_ACTIVATE,
    TimeMetric.START_TO_START: JobMetric.START_TO_START,
    TimeMetric.END_TO_END: JobMetric.END_TO_END,
    TimeMetric.END_TO_START: JobMetric.END_TO_START,
}
#: Differences, which can be negative.
_SIGNED = (TimeMetric.LATENESS, TimeMetric.END_TO_START)
#: Why a constraint is about nothing.
NO_LIMIT = "it states no limit"


def _deadline_quantity(is_implicit: bool) -> str:
    return f"response time, {'period' if is_implicit else 'deadline'}"


class JudgedDeadline:
    """The deadline of a process as a limit that was judged.

    Attributes
    ----------
    name : of the process
    is_implicit : whether the deadline is the period
    """

    __slots__ = ()

    name: str
    is_implicit: bool

    @property
    def object(self) -> str:
        """The process itself."""
        return self.name

    @property
    def quantity(self) -> str:
        """The response time, and what limits it."""
        return _deadline_quantity(self.is_implicit)

    @property
    def is_upper(self) -> bool:
        """A deadline limits the maximum."""
        return True


@dataclass(frozen=True, slots=True, kw_only=True)
class SystemLimit:
    """A limit of a system.

    Attributes
    ----------
    name : of the requirement, the constraint or the process
    object : what has the quantity: a process, a runnable, a chain, or events
    is_upper : whether a maximum must not exceed the limit; otherwise a minimum must not fall below it
    limit : picoseconds, or a number; None if it is kept or not, without a number
    is_time : whether it is a time
    is_signed : whether the quantity can be negative
    is_jitter : whether it limits how much the metric varies
    metric : of jobs or chains; None if it is about something else
    item : what states it
    """

    name: str
    object: str
    quantity: str
    limit: Time | Fraction | None
    item: Named
    is_upper: bool = True
    is_time: bool = True
    is_signed: bool = False
    is_jitter: bool = False
    metric: JobMetric | ChainQuantity | None = None

    @property
    def time(self) -> Time | None:
        """The limit of a time."""
        return self.limit if self.is_time and isinstance(self.limit, int) else None


@dataclass(frozen=True, slots=True)
class Deadline:
    """A deadline relative to the activation; `is_implicit` if it is the period."""

    value: Time
    is_implicit: bool


def deadline_of(process: str, context: TimingContext) -> Deadline | None:
    """The deadline of a process: of its allocation, or its strictest response-time limit, or its period."""
    system = context.system
    allocated = [each.deadline for each in system.mapping.tasks if each.task == process and each.deadline is not None]
    stated = min(allocated) if allocated else response_time_limits(system).get(process)
    if stated is not None:
        return Deadline(stated, is_implicit=False)
    # The rounds of an executor, and what they activate, have no period.
    if process in system.executor_of_task or process in context.with_uncertain_activations:
        return None
    events = context.stated_activations(process)
    period = None if events is None else implicit_deadline(events)
    return None if period is None else Deadline(period, is_implicit=True)


def deadline_limit(process: Process, deadline: Time, is_implicit: bool = False) -> SystemLimit:
    """The limit that a deadline is."""
    return SystemLimit(
        name=process.name,
        object=process.name,
        quantity=_deadline_quantity(is_implicit),
        limit=deadline,
        item=process,
        metric=JobMetric.RESPONSE_TIME,
    )


def activation_limit(process: Process) -> SystemLimit:
    """The limit of the jobs of a process that are pending at the same time; interrupt service routines state none."""
    most = process.activation_limit if isinstance(process, Task) else None
    return SystemLimit(name=process.name, object=process.name, quantity="pending jobs", limit=most, item=process, is_time=False)


def stated_limits(system: System) -> Iterator[tuple[Stated, tuple[SystemLimit, ...]]]:
    """What states limits, requirements first, each with its limits; without any if it states none or limits what it does not name."""
    constraints = system.constraints
    for item in (*constraints.requirements, *constraints.constraints, *constraints.data_ages, *constraints.orders):
        yield item, limits_of(item)


def limits_of(item: Stated) -> tuple[SystemLimit, ...]:
    """The limits that a requirement or a constraint states."""
    if isinstance(item, Requirement):
        return (_of_requirement(item),)
    return tuple(limit for limit in _of_constraint(item) if limit.limit is not None)


def without_number(item: Stated, what: str = "") -> SystemLimit:
    """The limit of a constraint that is kept or not, or of one that states none.

    Parameters
    ----------
    what : what is limited; default: what the constraint names
    """
    assert not isinstance(item, Requirement)
    unlimited = next(_of_constraint(item))
    return replace(unlimited, object=what) if what else unlimited


def nominal_period(limit: SystemLimit, system: System) -> Time | None:
    """The period from which a limited jitter is the deviation; None if the process has none."""
    process = system.processes.get(limit.object)
    return None if process is None else activation_period(process, system)


def is_from_period(limit: SystemLimit) -> bool:
    """Whether it limits a deviation from the nominal period."""
    return isinstance(limit.item, Requirement) and limit.is_jitter and is_deviation_from_period(limit.item.limit.metric)  # type: ignore[arg-type]


def _of_requirement(requirement: Requirement) -> SystemLimit:
    limit = requirement.limit
    metric = limit.metric
    is_jitter = isinstance(limit, JitterLimit)
    is_time = isinstance(limit, TimeLimit | JitterLimit)
    return SystemLimit(
        name=requirement.name,
        object=requirement.process or requirement.runnable or "",
        quantity=jitter_name(metric) if is_jitter else str(metric),
        # As the number is written: the nearest number in base 2 can be on the other side of an equal value.
        limit=limit.value if isinstance(limit, TimeLimit | JitterLimit) else Fraction(str(limit.value)),
        item=requirement,
        is_upper=limit.bound is Bound.UPPER,
        is_time=is_time,
        is_signed=metric in _SIGNED and not is_jitter,
        is_jitter=is_jitter,
        metric=JOB_METRICS.get(metric) if isinstance(metric, TimeMetric) else None,
    )


def _of_constraint(constraint: EventConstraint) -> Iterator[SystemLimit]:
    match constraint:
        case LatencyConstraint(kind=kind, chain=chain):
            is_age = kind is LatencyKind.AGE
            name = "data age" if is_age else "reaction"
            metric = ChainQuantity.REDUCED_DATA_AGE if is_age else ChainQuantity.REDUCED_REACTION_TIME
            yield from _between(constraint, chain, name, constraint.minimum, constraint.maximum, metric)
            yield SystemLimit(
                name=constraint.name,
                object=chain,
                quantity=jitter_name(name),
                limit=constraint.jitter,
                item=constraint,
                is_jitter=True,
                metric=metric,
            )
        case DelayConstraint(source=source, target=target, lower=lower, upper=upper):
            yield from _between(constraint, f"{source} to {target}", "delay", lower, upper)
        case RepetitionConstraint(event=event, lower=lower, upper=upper, jitter=jitter):
            yield from _between(constraint, event, "repetition", lower, upper)
            yield SystemLimit(
                name=constraint.name, object=event, quantity="jitter", limit=jitter, item=constraint, is_jitter=True
            )
        case EventSynchronization(events=events, tolerance=tolerance):
            yield from _between(constraint, ", ".join(events), "spread", None, tolerance)
        case ChainSynchronization(chains=chains, tolerance=tolerance, end=end):
            yield from _between(constraint, ", ".join(chains), f"spread at the {end}", None, tolerance)
        case DataAgeConstraint(label=label):
            yield from _between(constraint, label, "data age", constraint.earliest, constraint.latest)
            name, least, most = "data age in cycles", constraint.earliest_cycle, constraint.latest_cycle
            yield from _between(constraint, label, name, least, most, is_time=False)
        case OrderConstraint():
            yield SystemLimit(name=constraint.name, object="", quantity="order of runnables", limit=None, item=constraint)


def _between(
    constraint: EventConstraint,
    what: str,
    quantity: str,
    lower: Time | None,
    upper: Time | None,
    metric: ChainQuantity | None = None,
    *,
    is_time: bool = True,
) -> Iterator[SystemLimit]:
    for limit, is_upper in ((upper, True), (lower, False)):
        yield SystemLimit(
            name=constraint.name,
            object=what,
            quantity=quantity,
            limit=limit,
            item=constraint,
            is_upper=is_upper,
            is_time=is_time,
            metric=metric,
        )
