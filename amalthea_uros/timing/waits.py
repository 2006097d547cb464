"""Which process sets the events that a process waits for, where the model guarantees that it does.

Events of the operating system are those of OSEK: setting one that is set changes nothing, waiting does not clear it, and a process
clears its own ones (ISO 17356-3). Nobody waits for ever if each wait is of one of two kinds:

- **Round trip**: each job triggers another process, waits for the event that each job of that sets once, and clears it afterwards.
  Nothing else triggers that process or sets the event, so that a wait ends with the job that it triggered.
- **Periodic**: each job of a periodic process sets the event. Whatever was cleared before, the next job of that ends the wait.

Everything else is refused, with what is missing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import ClearEvent, SetEvent, WaitEvent, Waiting
from amalthea_uros.perf.distributions import highest, lowest
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Counter, InterProcess, Periodic
from amalthea_uros.timing.activation.activations import Activations
from amalthea_uros.timing.basics.time_base import Ticks
from amalthea_uros.timing.demand.model import DemandModel
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.jobs.counters import is_always
from amalthea_uros.timing.jobs.executed import executed
from amalthea_uros.timing.jobs.positions import ActivityPosition, is_in_fixed_order, positions
from amalthea_uros.units import Time

#: Why the demand of a process that waits is unknown.
WITHOUT_BOUND = "it waits for events without a timeout, so there is no upper bound"


@dataclass(frozen=True, slots=True)
class AwaitedEvent:
    """An event that each job of a process waits for.

    Attributes
    ----------
    setter : the process that sets it in each job
    gap : longest time from any moment to the next activation of a periodic setter; None: the job that waits triggers it
    is_last : whether setting it is the last activity of the setter
    is_active : whether who waits keeps its core, or may do so
    """

    event: str
    setter: str
    gap: Time | None
    is_last: bool
    is_active: bool


@dataclass(frozen=True, slots=True)
class WaitingProcess:
    """A process that waits for events.

    Attributes
    ----------
    demand : without the time for which it waits, in the time base of its core
    segments : the longest demand before each wait and after the last one, in the same unit; they overlap at what need not be in one
    """

    awaited: Sequence[AwaitedEvent]
    demand: MultiframeDemand
    segments: Sequence[Ticks]

    @property
    def polls(self) -> bool:
        """Whether it may keep its core while it waits."""
        return any(each.is_active for each in self.awaited)

    @classmethod
    def of(
        cls, process: Process, awaited: Sequence[AwaitedEvent], demand: MultiframeDemand, model: DemandModel, core: str
    ) -> WaitingProcess:
        """A process on a core, with its demand by a model that ignores waits."""
        everything = model.of_activities(process, process.activities, core).worst
        # Overheads of the job that belong to no activity may be anywhere, and those of the wait before or after it.
        apart, before, segments = demand.worst - everything, Ticks(0), list[Ticks]()
        for position in positions(process, model.system, model.sites):
            if isinstance(position.activity, WaitEvent):
                segments.append(Ticks(model.of_position(position, core, including=True).worst - before + apart))
                before = model.of_position(position, core, including=False).worst
        return cls(awaited, demand, (*segments, Ticks(everything - before + apart)))


def awaited_events(process: Process, activations: Activations) -> Sequence[AwaitedEvent]:
    """The events that each job of a process waits for.

    Raises
    ------
    UnknownError : it is not guaranteed that they are set.
    """
    system = activations.system
    if WaitEvent not in system.activity_classes:
        return ()
    if not any(isinstance(each, WaitEvent) for each in executed(process.activities, system)):
        return ()
    try:
        search = _Search(process, activations, activations.dataflow.events.positions(process.name))
        awaited = [search.awaited(wait, event) for wait in search.waits() for event in names_of(wait)]
        for name in (process.name, *(each.setter for each in awaited)):
            if name in system.executor_of_task:
                raise UnknownError(f"{name!r} is the task of an executor")
    except UnknownError as error:
        raise UnknownError(f"{WITHOUT_BOUND}: {error}") from error
    return awaited


def names_of(position: ActivityPosition) -> tuple[str, ...]:
    """The events of an activity that sets, clears or awaits some."""
    activity = position.activity
    return activity.events if isinstance(activity, SetEvent | ClearEvent | WaitEvent) else ()


@dataclass(frozen=True, slots=True)
class _Search:
    process: Process
    activations: Activations
    own: Sequence[ActivityPosition]

    def waits(self) -> Iterator[ActivityPosition]:
        """The places where the process waits."""
        for position in self.own:
            if isinstance(position.activity, WaitEvent):
                names = ", ".join(map(repr, position.activity.events))
                if len(position.activity.events) > 1 and not position.activity.all_of_them:
                    raise UnknownError(f"it waits for any of several events, {names}")
                if not _is_in_each_job(position):
                    raise UnknownError(f"not each of its jobs waits for {names} exactly once")
                yield position

    def awaited(self, wait: ActivityPosition, event: str) -> AwaitedEvent:
        """The event of a wait, with the process that sets it."""
        place = self._only_setting(event)
        stimuli = [self.activations.system.stimuli_by_name.get(name) for name in place.process.stimuli]
        gap: Time | None = None
        match stimuli:
            case [Periodic(condition=None, min_distance=None, period=period) as stimulus] if period > 0:
                gap = _longest_gap(stimulus)
            case [InterProcess(condition=None, counter=None) as stimulus]:
                self._require_round_trip(wait, event, place.process, stimulus)
            case _:
                raise UnknownError(
                    f"{place.process.name!r}, which sets {event!r}, is neither periodic nor triggered by it alone"
                )
        last = self.activations.dataflow.events.positions(place.process.name)[-1].number
        waiting = wait.activity.waiting if isinstance(wait.activity, WaitEvent) else None
        return AwaitedEvent(event, place.process.name, gap, place.number == last, waiting is not Waiting.PASSIVE)

    def _only_setting(self, event: str) -> ActivityPosition:
        """The only place where an event of the process is set."""
        places = [
            position
            for position in self.activations.dataflow.events.all_positions()
            if isinstance(position.activity, SetEvent)
            and event in position.activity.events
            and position.activity.process in (None, self.process.name)
        ]
        if not places:
            raise UnknownError(f"no process sets the event {event!r}")
        if len(places) > 1:
            raise UnknownError(f"the event {event!r} is set in {len(places)} places")
        if places[0].process.name == self.process.name or not _is_in_each_job(places[0]):
            raise UnknownError(f"not each job of {places[0].process.name!r} sets the event {event!r} exactly once for it")
        return places[0]

    def _require_round_trip(self, wait: ActivityPosition, event: str, setter: Process, stimulus: InterProcess) -> None:
        """Refuse a setter that other jobs trigger, too, or not each job, and an event that can be cleared too early or never."""
        causes = self.activations.causes(stimulus)
        if len(causes) != 1 or causes[0].process.name != self.process.name or not _is_in_each_job(causes[0].position):
            raise UnknownError(
                f"{setter.name!r}, which sets {event!r}, is not triggered exactly once by each job that waits for it"
            )
        trigger = causes[0].position.number
        if trigger > wait.number:
            raise UnknownError(f"it triggers {setter.name!r}, which sets {event!r}, only after it has waited for that")
        clears = [each for each in self.own if isinstance(each.activity, ClearEvent) and event in each.activity.events]
        if any(each.number < wait.number for each in clears if each.number > trigger):
            raise UnknownError(f"it clears {event!r} after it has triggered {setter.name!r}, and before it waits")
        if not any(each.number > wait.number and _is_in_each_job(each) for each in clears):
            raise UnknownError(f"not each of its jobs clears {event!r} after it has waited for it")


def _is_in_each_job(position: ActivityPosition) -> bool:
    """Whether each job executes an activity exactly once, at the same point."""
    own: Counter | None = getattr(position.activity, "counter", None)
    counts = position.counter is not None and is_always(position.counter) and (own is None or is_always(own))
    return counts and position.is_certain and position.times == 1 and is_in_fixed_order(position)


def _longest_gap(stimulus: Periodic) -> Time:
    """The longest time from any moment to the next activation, also before the first one."""
    if stimulus.jitter is None:
        return max(stimulus.period, stimulus.offset)
    earliest, latest = lowest(stimulus.jitter), highest(stimulus.jitter)
    if earliest is None or latest is None:
        raise UnknownError(f"the jitter of {stimulus.name!r} has no bounds")
    return max(stimulus.period, stimulus.offset) + max(latest, 0) - min(earliest, 0)
