"""What processes do, with everything in the runnables that they call."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil

from amalthea_uros.perf.events import (
    ChannelChange,
    ChannelEvent,
    CustomEvent,
    Event,
    LabelEvent,
    ModeChange,
    ModeLabelEvent,
    RunnableEvent,
)
from amalthea_uros.perf.software import (
    Activity,
    Call,
    Count,
    LabelAccess,
    ModeAccess,
    ModeOperation,
    Process,
    RaiseEvent,
    Receive,
    Send,
    walk,
)
from amalthea_uros.perf.system import System

_MODE_CHANGES = {
    ModeOperation.READ: ModeChange.READ,
    ModeOperation.SET: ModeChange.WRITE,
    ModeOperation.INCREMENT: ModeChange.INCREMENT,
    ModeOperation.DECREMENT: ModeChange.DECREMENT,
}


@dataclass(frozen=True, slots=True)
class Occurrence:
    """Something that a job does.

    Attributes
    ----------
    runnable : in which it does it; None: directly
    times : how often at most
    """

    process: Process
    runnable: str | None
    activity: Activity
    times: int = 1


def occurrences(system: System) -> Iterator[Occurrence]:
    """Everything that the jobs of all processes may do, in order."""
    for process in system.processes.values():
        everything = _within(process.activities, process, None, 1, (), system)
        yield from (what for what in everything if what.times > 0)


def _within(
    activities: tuple[Activity, ...],
    process: Process,
    runnable: str | None,
    times: int,
    above: tuple[str, ...],
    system: System,
) -> Iterator[Occurrence]:
    for activity in walk(activities):
        if isinstance(activity, Call):
            repeated = times * _most(activity.times)
            yield Occurrence(process, runnable, activity, repeated)
            called = system.runnables.get(activity.runnable)
            if called is not None and called.name not in above:
                yield from _within(called.activities, process, called.name, repeated, (*above, called.name), system)
        elif isinstance(activity, LabelAccess):
            yield Occurrence(process, runnable, activity, times * _most(activity.times))
        else:
            yield Occurrence(process, runnable, activity, times)


def _most(times: Count | float | None) -> int:
    if times is None:
        return 1
    return times.most if isinstance(times, Count) else ceil(times)


def raises(what: Occurrence, event: Event) -> bool:
    """Whether an event is one that occurs when something is done; what an event leaves open fits everything."""
    process, runnable = what.process.name, what.runnable
    match event, what.activity:
        case CustomEvent(name=name), RaiseEvent(event=raised):
            return name == raised
        case RunnableEvent(), Call(runnable=called):
            return _fits((event.runnable, called), (event.process, process))
        case LabelEvent(), LabelAccess(label=label, kind=kind):
            change = None if event.change is None else str(event.change)
            return _fits((event.label, label), (change, str(kind)), (event.runnable, runnable), (event.process, process))
        case ModeLabelEvent(), ModeAccess(label=label, operation=operation):
            change = _MODE_CHANGES[operation]
            return _fits((event.label, label), (event.change, change), (event.runnable, runnable), (event.process, process))
        case ChannelEvent(), Send(channel=channel):
            change = ChannelChange.SEND
            return _fits((event.channel, channel), (event.change, change), (event.runnable, runnable), (event.process, process))
        case ChannelEvent(), Receive(channel=channel):
            change = ChannelChange.RECEIVE
            return _fits((event.channel, channel), (event.change, change), (event.runnable, runnable), (event.process, process))
    return False


def _fits(*pairs: tuple[str | None, str | None]) -> bool:
    return all(wanted is None or wanted == found for wanted, found in pairs)
