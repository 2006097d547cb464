"""Constraints on events and on runnables: what they limit in a play, in each way in which they can be read, and how they are written.

Where the text of the language leaves something open, all readings are measured, and only what is broken in all of them is broken.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import ClassVar, NamedTuple
from urllib.parse import quote_plus

from opponent.models.chains import Chain, answers, readings
from opponent.models.player import NEVER, Job, Mark, Player
from opponent.models.reading import Played

MICROSECOND = 10**6


class EventOf(NamedTuple):
    """Something that happens to a process, to a runnable or to data, in any process and runnable or in some."""

    kind: str
    name: str
    change: str
    process: str = ""
    runnable: str = ""


class Value(NamedTuple):
    """What a constraint limits in some of its readings; incomplete values are at least that great."""

    value: int
    readings: tuple[int, ...] = (0,)
    is_complete: bool = True


#: Gives the reference to an event, which it adds to the model.
Referring = Callable[[EventOf], str]


class Play:
    """What happens in a play up to its end."""

    def __init__(self, played: Played, run: Player, until: int) -> None:
        self.played, self.run, self.until = played, run, until
        self.jobs: dict[str, list[Job]] = {p.name: jobs for p, jobs in zip(played.processes, run.jobs, strict=True)}

    def times(self, event: EventOf) -> list[int]:
        """When an event occurs, in order."""
        if event.kind == "process":
            of = {"activate": lambda job: job.activated, "start": lambda job: job.start, "terminate": lambda job: job.end}
            found = [of[event.change](job) for job in self.jobs[event.name]]
            return sorted(time for time in found if time is not None)
        return sorted(
            mark.time
            for process, jobs in self.jobs.items()
            if event.process in ("", process)
            for job in jobs
            for mark in job.marks
            if (mark.change, mark.name) == (event.change, event.name) and event.runnable in ("", mark.runnable)
        )


@dataclass(frozen=True, slots=True)
class Constraint(ABC):
    """A constraint that can be limited at what occurs."""

    name: str
    #: What limits are whole multiples of, and the least of them.
    unit: ClassVar[int] = MICROSECOND
    least: ClassVar[int] = MICROSECOND
    #: Whether there are lower limits, too.
    has_lower: ClassVar[bool] = True

    @abstractmethod
    def values(self, play: Play) -> Iterator[Value]:
        """What occurs."""

    @abstractmethod
    def text(self, name: str, limit: int, event: Referring, *, is_upper: bool) -> str:
        """The constraint with a limit; of times, in picoseconds."""


def _time(tag: str, value: int) -> str:
    return f'<{tag} value="{value // MICROSECOND}" unit="us"/>'


def element(kind: str, name: str, attributes: str, content: str, tag: str = "timingConstraints") -> str:
    """A constraint with a name."""
    return f'<{tag} xsi:type="am:{kind}" xmi:id="{quote_plus(name)}?type={kind}" name="{name}" {attributes}>{content}</{tag}>'


@dataclass(frozen=True, slots=True)
class Delay(Constraint):
    """From an event to another one. That some target is in time is necessary for a unique reaction, too."""

    source: EventOf
    target: EventOf
    mapping: str

    def values(self, play: Play) -> Iterator[Value]:
        sources, targets = play.times(self.source), play.times(self.target)
        if self.mapping == "OneToOne":
            pairs = list(zip(sources, targets, strict=False))
            yield from (Value(max(then - first, 0), (0, 1)) for first, then in pairs)
            yield from (Value(play.until - first, (0, 1), is_complete=False) for first in sources[len(targets) :])
            if len(targets) > len(sources) or any(then < first for first, then in pairs):
                yield Value(NEVER, (1,), is_complete=False)
            return
        for source in sources:
            found = bisect_left(targets, source)
            # A later target can keep a lower limit, so that none of them is complete.
            end = targets[found] if found < len(targets) else play.until
            yield Value(end - source, (0, 1), is_complete=False)
        if self.mapping == "UniqueReaction":
            yield Value(NEVER, (1,), is_complete=False)

    def text(self, name: str, limit: int, event: Referring, *, is_upper: bool) -> str:
        source, target = event(self.source), event(self.target)
        bound = _time("upper" if is_upper else "lower", limit)
        return element("DelayConstraint", name, f'mappingType="{self.mapping}" source="{source}" target="{target}"', bound)


@dataclass(frozen=True, slots=True)
class Repetition(Constraint):
    """From an occurrence to the one that is a number of times later."""

    event: EventOf
    span: int

    def values(self, play: Play) -> Iterator[Value]:
        times = play.times(self.event)
        yield from (Value(then - first, (0, 1)) for first, then in zip(times, times[self.span :], strict=False))
        # Whether what does not come again is late is open.
        yield from (Value(play.until - first, (1,), is_complete=False) for first in times[-self.span :])

    def text(self, name: str, limit: int, event: Referring, *, is_upper: bool) -> str:
        attributes = f'event="{event(self.event)}" span="{self.span}"'
        return element("RepetitionConstraint", name, attributes, _time("upper" if is_upper else "lower", limit))


@dataclass(frozen=True, slots=True)
class Deviation(Constraint):
    """How late an event comes after points at the distance of a period, which are as good as they can be."""

    event: EventOf
    period: int

    has_lower = False

    def values(self, play: Play) -> Iterator[Value]:
        late = [time - number * self.period for number, time in enumerate(play.times(self.event))]
        if len(late) > 1:
            yield Value(max(late) - min(late))

    def text(self, name: str, limit: int, event: Referring, *, is_upper: bool) -> str:
        content = _time("period", self.period) + _time("jitter", limit)
        return element("RepetitionConstraint", name, f'event="{event(self.event)}" span="1"', content)


@dataclass(frozen=True, slots=True)
class Synchronization(Constraint):
    """How far events that belong together are apart."""

    events: tuple[EventOf, ...]
    is_multiple: bool

    has_lower = False

    def values(self, play: Play) -> Iterator[Value]:
        times = [play.times(event) for event in self.events]
        yield from (Value(value, (0,), is_complete) for value, is_complete in narrowest(times, play.until))
        if not self.is_multiple:
            for number, (with_equal, order) in enumerate(product((True, False), (1, -1))):
                found = windows(times[::order], play.until, with_equal=with_equal)
                yield from (Value(value, (-2 - number,), is_complete) for value, is_complete in found)

    def text(self, name: str, limit: int, event: Referring, *, is_upper: bool) -> str:
        events = " ".join(map(event, self.events))
        attributes = f'events="{events}" multipleOccurrencesAllowed="{str(self.is_multiple).lower()}"'
        return element("EventSynchronizationConstraint", name, attributes, _time("tolerance", limit))


def narrowest(events: Sequence[list[int]], until: int) -> Iterator[tuple[int, bool]]:
    """For each occurrence, the narrowest window around it in which every event occurs."""
    for time in sorted({time for times in events for time in times}):
        best = until - time
        is_complete = False
        begins = sorted({begin for times in events for begin in times if begin <= time}, reverse=True)
        for begin in begins:
            if time - begin >= best:
                break
            places = [bisect_left(times, begin) for times in events]
            if all(place < len(times) for place, times in zip(places, events, strict=True)):
                end = max(time, *(times[place] for place, times in zip(places, events, strict=True)))
                if end - begin < best:
                    best, is_complete = end - begin, True
        yield best, is_complete


def windows(events: Sequence[list[int]], until: int, *, with_equal: bool) -> Iterator[tuple[int, bool]]:
    """Windows one after the other, each up to where all events have occurred; of one instant, the rest can belong to it or not.

    Events of one instant come in the given order.
    """
    order = sorted((time, number) for number, times in enumerate(events) for time in times)
    begin, seen, end = None, set[int](), -1
    for time, number in order:
        if begin is None:
            if with_equal and time == end:
                continue
            begin = time
        seen.add(number)
        if len(seen) == len(events):
            yield time - begin, True
            begin, end = None, time
            seen.clear()
    if begin is not None:
        yield until - begin, False


@dataclass(frozen=True, slots=True)
class ChainSynchronization(Constraint):
    """How far two chains are apart at an end: all such events, or, from the same stimulus, the responses to each."""

    chains: tuple[Chain, Chain]
    end: str
    has_same_stimulus: bool
    is_multiple: bool

    has_lower = False

    def values(self, play: Play) -> Iterator[Value]:
        yield from Synchronization("", tuple(map(self._event, self.chains)), self.is_multiple).values(play)
        if self.end == "Stimulus" or not self.has_same_stimulus:
            return
        for number, (one, other) in enumerate(product(*map(readings, self.chains)), 1):
            pairs = zip(
                *(answers(play.played, play.run, chain, links) for chain, links in zip(self.chains, (one, other), strict=True)),
                strict=False,
            )
            found = [(first, then) for (_, first), (_, then) in pairs]
            yield from (
                Value(abs((play.until if first is None else first) - (play.until if then is None else then)), (number,))
                for first, then in found
            )
            if not found:
                yield Value(0, (number,))
        if any(chain.stimulus == "terminate" for chain in self.chains):
            # What a job has written just before its end may also not come from that, so that the next job answers, however late.
            yield Value(NEVER, (-1,), is_complete=False)

    def _event(self, chain: Chain) -> EventOf:
        process, event = (
            (chain.processes[0], chain.stimulus) if self.end == "Stimulus" else (chain.processes[-1], chain.response)
        )
        change, _, name = event.partition(" ")
        if not name:
            return EventOf("process", process, change)
        return EventOf("label" if change in ("read", "write") else "runnable", name, change, process)

    def text(self, name: str, limit: int, event: Referring, *, is_upper: bool) -> str:
        scope = " ".join(f"{quote_plus(chain.name)}?type=EventChain" for chain in self.chains)
        attributes = f'scope="{scope}" type="{self.end}" multipleOccurrencesAllowed="{str(self.is_multiple).lower()}"'
        return element("EventChainSynchronizationConstraint", name, attributes, _time("tolerance", limit))


@dataclass(frozen=True, slots=True)
class Age(Constraint):
    """How old the data of a runnable are where other processes read them."""

    runnable: str
    label: str
    writer: str

    def values(self, play: Play) -> Iterator[Value]:
        for reading, _, written, time in self._reads(play):
            yield Value(time - written, (reading,))

    def _reads(self, play: Play) -> Iterator[tuple[int, str, int, int]]:
        """Each read, with the reading, its process and the time of the write."""
        writes = play.times(EventOf("label", self.label, "write", runnable=self.runnable))
        for process in play.jobs:
            for time in play.times(EventOf("label", self.label, "read", process)) if process != self.writer else ():
                # Whether what is written at the same instant is read already is open.
                for reading, search in enumerate((bisect_right, bisect_left)):
                    found = search(writes, time) - 1
                    if found >= 0:
                        yield reading, process, writes[found], time

    def text(self, name: str, limit: int, event: Referring, *, is_upper: bool) -> str:
        bound = _time("maximumTime" if is_upper else "minimumTime", limit)
        return self._element(name, f'<dataAge xsi:type="am:DataAgeTime">{bound}</dataAge>')

    def _element(self, name: str, age: str) -> str:
        attributes = f'runnable="{self.runnable}?type=Runnable" label="{self.label}?type=Label"'
        return element("DataAgeConstraint", name, attributes, age, "dataAgeConstraints")


@dataclass(frozen=True, slots=True)
class AgeInCycles(Age):
    """The same in activations of the process that writes."""

    unit = 1
    least = 1

    def values(self, play: Play) -> Iterator[Value]:
        activations = play.times(EventOf("process", self.writer, "activate"))
        for reading, _, written, time in self._reads(play):
            # It is also open whether activations at these instants count, and whether the write counts as one of its activation.
            within = bisect_left(activations, time) - bisect_right(activations, written)
            yield Value(max(within, 0), (2 * reading,))
            yield Value(bisect_right(activations, time) - bisect_left(activations, written), (2 * reading + 1,))

    def text(self, name: str, limit: int, event: Referring, *, is_upper: bool) -> str:
        # Both are stated, or none; the other one excludes nothing.
        most, least = (limit, 0) if is_upper else (10**6, limit)
        return self._element(name, f'<dataAge xsi:type="am:DataAgeCycle" minimumCycle="{least}" maximumCycle="{most}"/>')


ORDERS = ("successor", "immediateSuccessorAnySequence", "immediateSuccessorStartSequence", "immediateSuccessorEndSequence")


@dataclass(frozen=True, slots=True)
class Order(Constraint):
    """Runnables one after the other; the value is 1 where they are not."""

    first: str
    then: str
    kind: str
    scope: tuple[tuple[str, str], ...]

    unit = 1
    least = 0
    has_lower = False

    def values(self, play: Play) -> Iterator[Value]:
        names = [name for name, _ in self.scope] or list(play.jobs)
        callers = {
            name: {mark.name for job in play.jobs[name] for mark in job.marks if mark.change == "start"}
            & {self.first, self.then}
            for name in names
        }
        both = [name for name, called in callers.items() if len(called) == 2]
        some = [name for name, called in callers.items() if called]
        if both and both == some:
            for job in (job for name in both for job in play.jobs[name] if job.end is not None):
                at_least, at_most = self._in_job([m for m in job.marks if m.change in ("start", "terminate")])
                yield Value(int(at_least), (0,))
                yield Value(int(at_most), (1,))
        elif len(some) == 2 and not both:
            yield from self._across(play, some)

    def _in_job(self, marks: list[Mark]) -> tuple[bool, bool]:
        """Whether a job breaks the order in all readings, and whether in some."""
        if any([mark.name for mark in marks].count(name) != 2 for name in (self.first, self.then)):
            return False, True
        places = {(mark.change, mark.name): number for number, mark in enumerate(marks)}
        begins, ended = places["start", self.first], places["terminate", self.first]
        starts, leaves = places["start", self.then], places["terminate", self.then]
        if starts < ended:
            return True, True
        if self.kind == "successor":
            return False, False
        around = {
            "immediateSuccessorStartSequence": (marks[:begins], "terminate"),
            "immediateSuccessorEndSequence": (marks[leaves + 1 :], "start"),
        }
        others, whole = around.get(self.kind, ([], ""))
        between = marks[ended + 1 : starts]
        opened = {mark.name for mark in between if mark.change == "start"}
        is_between = any(mark.change == "terminate" and mark.name in opened for mark in between)
        # What is around one of them only, is partly in between: that is open.
        return is_between or any(mark.change == whole for mark in others), bool(between or others)

    def _across(self, play: Play, names: list[str]) -> Iterator[Value]:
        """The executions that belong together are the first ones, the second ones, and so on, if there are as many."""
        called = [
            sum(mark.change == "start" and mark.name in (self.first, self.then) for mark in job.marks)
            for name in names
            for job in play.jobs[name]
            if job.end is not None
        ]
        one, other = (len(play.jobs[name]) for name in names)
        corresponds = set(called) == {1} and abs(one - other) <= 1
        ends = play.times(EventOf("runnable", self.first, "terminate"))
        for number, start in enumerate(play.times(EventOf("runnable", self.then, "start"))):
            end = ends[number] if number < len(ends) else play.until
            yield Value(int(start < end and corresponds and self.kind == "successor"), (0,))
            # At one instant on two cores it is open, too.
            yield Value(int(start <= end or not corresponds or self.kind != "successor"), (1,))

    def text(self, name: str, limit: int, event: Referring, *, is_upper: bool) -> str:
        groups = "".join(f'<runnableGroups runnables="{each}?type=Runnable"/>' for each in (self.first, self.then))
        scope = " ".join(f"{process}?type={kind}" for process, kind in self.scope)
        attributes = f'orderType="{self.kind}"' + (f' processScope="{scope}"' if scope else "")
        return element("RunnableSequencingConstraint", name, attributes, groups, "runnableSequencingConstraints")
