"""Failures by their root causes: each is counted once, however many limits show it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Generic, Protocol, TypeAlias, TypeVar

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.judge.limits import SystemLimit
from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.constraints import (
    ChainSynchronization,
    DelayConstraint,
    EventSynchronization,
    LatencyConstraint,
    RepetitionConstraint,
    Requirement,
)
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.chains import events_of


class LimitedObject(Protocol):
    """What a limit is about."""

    @property
    def object(self) -> str:
        """What has the quantity."""

    @property
    def quantity(self) -> str:
        """What is limited."""

    @property
    def is_upper(self) -> bool:
        """Whether the maximum is limited; otherwise the minimum."""


class Failing(LimitedObject, Protocol):
    """What is not met."""

    @property
    def overloaded_core(self) -> str | None:
        """The core that cannot execute a process; None if nothing is overloaded."""

    @property
    def stated(self) -> SystemLimit | None:
        """The limit in the system; None for a process."""


class NamedCore(Protocol):
    """A core."""

    @property
    def name(self) -> str:
        """Of the core."""


F = TypeVar("F", bound=Failing)
Q = TypeVar("Q", bound=LimitedObject)
K = TypeVar("K", bound=NamedCore)
#: An overloaded core, or a limited quantity: object, name, and whether its maximum is limited.
_Key: TypeAlias = str | tuple[str, str, bool]


@dataclass(frozen=True, slots=True)
class FailureCause(Generic[F, K]):
    """A failure.

    Attributes
    ----------
    root : what shows it first: an overloaded core, or a limit that is missed
    consequences : other limits that are missed or unknown because of it
    """

    root: F | K
    consequences: tuple[F, ...] = ()


def distinct(items: Iterable[Q]) -> list[Q]:
    """One item for each quantity: a late task and the requirement on its response time are one failure."""
    found: dict[_Key, Q] = {}
    for item in items:
        found.setdefault(quantity_of(item), item)
    return list(found.values())


def causes(
    overloaded: Iterable[K],
    failing: Sequence[F],
    unknown: Sequence[F],
    processes_of: Callable[[SystemLimit], Collection[str]],
) -> tuple[FailureCause[F, K], ...]:
    """The failures, in order: what an overload makes endless is a consequence of it.

    Parameters
    ----------
    overloaded : the cores that no process shows as overloaded
    processes_of : the processes whose jobs decide about a limited quantity
    """
    core_of = {item.object: item.overloaded_core for item in failing if item.overloaded_core is not None}

    def core(item: F) -> str | None:
        if item.overloaded_core is not None or item.stated is None or not core_of:
            return item.overloaded_core
        return next((core_of[name] for name in sorted(processes_of(item.stated)) if name in core_of), None)

    found: dict[_Key, list[F]] = {}
    for item in sorted(distinct(failing), key=lambda item: item.overloaded_core is None):
        found.setdefault(core(item) or quantity_of(item), []).append(item)
    for item in distinct(unknown):
        if (key := core(item)) is not None:
            found[key].append(item)
    of_cores: list[FailureCause[F, K]] = [FailureCause(each) for each in overloaded]
    return (*of_cores, *(FailureCause(root, tuple(consequences)) for root, *consequences in found.values()))


def quantity_of(item: LimitedObject) -> _Key:
    """What is limited; the quantity of a process says after a comma what limits it."""
    return item.object, item.quantity.partition(",")[0], item.is_upper


def processes_of(limit: SystemLimit, context: TimingContext) -> set[str]:
    """The processes whose jobs decide about a limited quantity, as far as that is known."""
    system, item = context.system, limit.item
    names: Collection[str]
    match item:
        case Requirement(process=str(process)):
            return {process}
        case Requirement(runnable=runnable):
            return {process for process in system.processes if _calls(process, runnable, context)}
        case LatencyConstraint(chain=chain):
            names = events_of(system.chains[chain], system) if chain in system.chains else ()
        case DelayConstraint(source=source, target=target):
            names = (source, target)
        case RepetitionConstraint(event=event):
            names = (event,)
        case EventSynchronization(events=events):
            names = events
        case ChainSynchronization(chains=chains):
            names = {name for chain in chains if chain in system.chains for name in events_of(system.chains[chain], system)}
        case _:
            names = ()
    return {process for name in names for process in _raising(name, context)}


def _calls(process: str, runnable: str | None, context: TimingContext) -> bool:
    positions = context.dataflow.events.positions(process)
    return any(isinstance(each.activity, Call) and each.activity.runnable == runnable for each in positions)


def _raising(name: str, context: TimingContext) -> set[str]:
    event = context.system.events_by_name.get(name)
    try:
        return set() if event is None else {each.process.name for each in context.dataflow.events.of(event)}
    except UnknownError:
        return set()
