"""The cycle of an executor: from the moment when it has fixed what is ready, after a wait, to the same moment of the next iteration.

Without the wait, a cycle consists of the rest of the iteration, what the loop does between two waits, and the beginning of the next
iteration:

- `spin_some` with a sleep D: D + the time to execute an iteration
- `spin`: the time to execute an iteration
- `spin_period` with a period P: the invocation time is never later than the moment when the iteration began, and the thread sleeps
  until one period after it, or not at all. So it is at most the greater of P and the time to execute an iteration. As sleeps are cut to
  whole milliseconds, an iteration can begin up to 1 ms before its invocation time, which makes it 1 ms more.

An iteration executes the overhead of the executor once. Which part of it comes before the wait is unknown, so that its part after the
sleep can be all of it; the time of a cycle with a sleep is the lesser of two bounds: the sleep in the middle of one window, and two
windows.

If several executors spin in the loop of a thread, a cycle of one of them contains everything else in the loop: an iteration of each of
the others with its longest wait, and all sleeps. Busy waits follow the callbacks of an iteration, and count like their execution.

A wait answers the heartbeats that are unread, whose number depends on the cycle: the least number that is consistent is the bound
(`backlog`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.bounds.backlog import (
    acknowledged,
    backlog_age,
    has_unacknowledged,
    max_heartbeats,
    reads_all,
)
from amalthea_uros.executors.bounds.sent_again import (
    answers_besides,
    is_refused,
    reading_time,
    repeated,
    sent_again_in,
    writing_again,
)
from amalthea_uros.executors.bounds.sequences import CycleSequence
from amalthea_uros.executors.bounds.solved_system import SolvedSystem, ThreadProcessor
from amalthea_uros.executors.bounds.transmissions import wire_hop
from amalthea_uros.executors.semantics.demand import IterationDemand
from amalthea_uros.executors.semantics.loops import (
    SLEEP_RESOLUTION,
    longest_until_due,
    longest_wait,
    min_pace,
    sleep_of,
    timeout_of,
)
from amalthea_uros.executors.semantics.losses import publications, recovers
from amalthea_uros.executors.semantics.readiness import (
    can_defer,
    has_backlog,
    is_independent,
    is_message,
    messages,
    others_of_thread,
    reads_in_waits,
    sharing,
    takes_one_message,
    thread_of,
    timers,
)
from amalthea_uros.executors.semantics.suspension import (
    NONE,
    ProtocolWrites,
    Suspension,
    acknowledgements,
    heartbeats,
    in_sequence,
    longest_of,
    session_wait,
    suspension_of,
    writing_in_wait,
)
from amalthea_uros.perf.executors import Executor, Handle, HandleKind, LoopKind
from amalthea_uros.perf.network import Direction, Span
from amalthea_uros.units import Interval, Time

#: After which the number of heartbeats in a wait is considered unbounded.
_STEPS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class IterationPart:
    """A part of an iteration: execution in the time base of the core, suspensions in picoseconds."""

    demand: Time
    suspension: Suspension

    @property
    def resumed(self) -> int:
        """How often the thread becomes ready in it."""
        return 1 + self.suspension.times


@dataclass(frozen=True)
class Cycle:
    """The iterations of an executor.

    Attributes
    ----------
    sending : times of publications, by the names of transmissions
    takes_one : whether at most one handle that receives messages is ready in an iteration
    session_wait : how long others can keep the session when it is needed
    writing : how long a wait is extended by acknowledgements of what it reads, and heartbeats
    again : how long it is extended by what is sent again, because messages are lost
    backlog_age : how long a message can wait unread; None if that has no bound, or nothing is acknowledged
    others : an iteration with its wait of each other executor in the loop of the thread
    usual_others : the same without what the loop does in intervals of its own
    other_demands : of the other executors in the loop, by their names
    """

    executor: Executor
    solved: SolvedSystem
    processor: ThreadProcessor
    demand: IterationDemand
    sending: Mapping[str, Span]
    takes_one: bool
    session_wait: Time | None = 0
    writing: Suspension = NONE
    again: Suspension = NONE
    backlog_age: Time | None = None
    others: tuple[IterationPart, ...] = ()
    usual_others: tuple[IterationPart, ...] = ()
    other_demands: Mapping[str, IterationDemand] = field(default_factory=dict)

    @classmethod
    def of(cls, executor: Executor, solved: SolvedSystem, sending: Mapping[str, Span]) -> Cycle:
        """The iterations of an executor.

        Raises
        ------
        UnknownError : its execution demand, what can preempt it, or what else is done in the loop is unknown.
        """
        return cls.without_sending(executor, solved).with_sending(sending)

    @classmethod
    def without_sending(cls, executor: Executor, solved: SolvedSystem) -> Cycle:
        """The same before it is known how long publications take."""
        processor = solved.processor(executor.task)
        demand = IterationDemand.of(executor, solved.context)
        system = solved.context.system
        takes_one = takes_one_message(executor, system)
        demands = {each.name: IterationDemand.of(each, solved.context) for each in others_of_thread(executor, system.executors)}
        return cls(executor, solved, processor, demand, {}, takes_one, other_demands=demands)

    def with_sending(self, sending: Mapping[str, Span]) -> Cycle:
        """The same if publications take such times."""
        return replace(self, sending=sending)._consistent()

    def _consistent(self) -> Cycle:
        """The cycle with the least number of messages that its wait writes."""
        writes = ProtocolWrites()
        for _ in range(_STEPS):
            cycle = self._with(writes)
            again = cycle._writes()
            if again == writes:
                return cycle
            writes = again
        return self._with(ProtocolWrites(acknowledgements=None, heartbeats=None))

    def _with(self, writes: ProtocolWrites) -> Cycle:
        system = self.solved.context.system
        cycle = replace(
            self,
            session_wait=session_wait(self.executor, system, self.sending, writes),
            writing=writing_in_wait(self.executor, system, self.sending, writes),
        )
        cycle = replace(cycle, again=writing_again(writes.again, self.solved))
        others = tuple(cycle._with_wait(each, writes) for each in self._others_of_thread)
        usual = others
        if self._intervals:
            usual = tuple(cycle._with_wait(_without_rare_items(each), writes) for each in self._others_of_thread)
        cycle = replace(cycle, others=others, usual_others=usual)
        if not acknowledgements(system):
            return cycle
        return replace(cycle, backlog_age=cycle._backlog_age())

    def _with_wait(self, other: Executor, writes: ProtocolWrites) -> IterationPart:
        """An iteration of another executor in the loop of the thread, with its longest wait."""
        system, wait = self.solved.context.system, longest_wait(other)
        cycle = replace(
            self,
            executor=other,
            demand=self.other_demands[other.name],
            takes_one=takes_one_message(other, system),
            session_wait=session_wait(other, system, self.sending, writes),
            writing=writing_in_wait(other, system, self.sending, writes),
        )
        part, suspended = cycle.whole, cycle._suspended(wait)
        waiting = Suspension(most=suspended, times=cycle._resumed(wait) + 1, why=f"the loop also waits for {other.name!r}")
        return IterationPart(demand=part.demand, suspension=in_sequence([part.suspension, waiting]))

    def _backlog_age(self) -> Time | None:
        """The greatest age of a message in the receive buffer; if this executor does not read in its waits, that of one that does."""
        system = self.solved.context.system
        publishing = (each for handle in self.executor.handles for each in handle.publications)
        is_repeated = any(recovers(each, system) for each in publishing) or repeated(Direction.TO_CONTROLLER, self.solved)
        if is_repeated and (reads_in_waits(self.executor) or timers(self.executor)):
            return self._age_with_losses()
        if reads_in_waits(self.executor):
            return backlog_age(self.longest, self._without_reading.in_sequence(), self.sending, self.solved)
        readers = filter(reads_in_waits, sharing(self.executor, system.executors))
        ages = (_age_by(each, self.solved, self.sending) for each in readers)
        return min((age for age in ages if age is not None), default=None)

    def _age_with_losses(self) -> Time | None:
        """The greatest age of a message if some are sent again: see `sent_again`."""
        age = Time(0)
        for _ in range(_STEPS):
            reading = self.processor.time(0, reading_time(age, self.solved))
            if reading is None:
                return None
            ages = self._until_read_by_wait(reading), self._until_read_by_publication(reading)
            found = min((each for each in ages if each is not None), default=None)
            if found is None or found == age:
                return found
            age = found
        return None

    def _until_read_by_wait(self, reading: Time) -> Time | None:
        cycles = self._besides_publications.in_sequence()
        if cycles is None or not reads_in_waits(self.executor):
            return None
        reads_on = not timers(self.executor) and reading < timeout_of(self.executor)
        return backlog_age(reading + cycles.longest, cycles, self.sending, self.solved, reads_on=reads_on)

    def _until_read_by_publication(self, reading: Time) -> Time | None:
        """How long it can take until a publication of a timer has read everything.

        From any time, the timer is due again after its period at most, and called a cycle later at most. A publication that is under
        way ends before, when it has read the receive backlog.
        """
        if is_refused(reading, self.publication_distance, self.processor, self.solved):
            return None
        cycle = self._besides_publications
        times = [(longest_until_due(each), cycle.longest, cycle.until_end(each)) for each in self._publishing_timers]
        known = [sum(filter(None, parts)) for parts in times if None not in parts]
        return min(known) + 2 * reading if known else None

    @property
    def publication_distance(self) -> Time | None:
        """The greatest distance of the beginnings of two publications that wait; None if no timer publishes, or it has no bound."""
        times = [(longest_until_due(each), self.longest_with_wait, self.until_end(each)) for each in self._publishing_timers]
        return min((sum(filter(None, parts)) for parts in times if None not in parts), default=None)

    @property
    def _publishing_timers(self) -> list[Handle]:
        """The timers with a publication that waits on a wire with losses."""
        system = self.solved.context.system
        return [each for each in timers(self.executor) if any(recovers(one, system) for one in each.publications)]

    @property
    def _besides_publications(self) -> Cycle:
        """Cycles in which publications only write, and nothing again."""
        system = self.solved.context.system
        waiting = {each.transmission or "" for each in publications(system) if recovers(each, system)}
        written = {name: Span(most=wire_hop(system.transmissions[name], self.solved).worst) for name in waiting}
        return replace(self, sending={**self.sending, **written}, again=NONE)

    def _writes(self) -> ProtocolWrites:
        """How often a wait writes, if the cycle is like this."""
        system = self.solved.context.system
        asked = [each for name, each in acknowledged(self.solved).items() if system.transmissions[name].callback is None]
        unread = [None if each is None or self.backlog_age is None else each.most(self.backlog_age) for each in asked]
        count = None if None in unread else sum(filter(None, unread)) + 1
        # What is sent again in a wait is sent in its cycle.
        again = sent_again_in(self.longest_with_wait, self.solved) if reads_in_waits(self.executor) else 0
        # What it reads besides came in the time before that, or in its cycle.
        times = self.backlog_age, self.longest_with_wait
        replies = answers_besides(None if None in times else sum(filter(None, times)), self.solved)
        written = None if again is None or replies is None else again + replies
        return ProtocolWrites(acknowledgements=count, heartbeats=0 if again else self._heartbeats, again=written)

    @property
    def _heartbeats(self) -> int | None:
        """The heartbeats of the client in a wait: only if something can be sent and not be acknowledged then.

        They are an interval apart, and the timeout includes them, but for the last reading of it, whose time counts from its beginning.
        """
        if not heartbeats(self.solved.context.system) or not has_unacknowledged(self.sending, self.solved):
            return 0
        of_thread = thread_of(self.executor, self.solved.context.system.executors)
        return max_heartbeats(max(map(longest_wait, of_thread)), self.solved)

    @property
    def time_base(self) -> int:
        """Time units per picosecond on the core."""
        return self.processor.time_base

    @cached_property
    def has_backlog(self) -> bool:
        """Whether messages can be stored before an iteration that takes them."""
        return has_backlog(self.executor, self.solved.context.system)

    @property
    def sleep(self) -> Time:
        """The sleep after each iteration."""
        return sleep_of(self.executor).upper

    def suspension(self, handle: Handle) -> Suspension:
        """The suspension of a callback."""
        return suspension_of(handle, self.solved.context.system, self.sending, self.session_wait)

    @cached_property
    def whole(self) -> IterationPart:
        """The longest iteration: its overhead, and all callbacks that one iteration can call."""
        always = [handle for handle in self.executor.handles if is_independent(handle)]
        excluded = [handle for handle in self.executor.handles if not is_independent(handle)]
        return self._part(always, excluded, self.demand.spin.upper + self.demand.after.upper)

    def _part(self, always: Sequence[Handle], excluded: Sequence[Handle], demand: Time) -> IterationPart:
        """The demand of some handles; of those that exclude each other, the longest."""
        if not self.takes_one:
            always, excluded = (*always, *excluded), ()
        demand += sum(self.demand.of_handle(handle).upper for handle in always)
        demand += max((self.demand.of_handle(handle).upper for handle in excluded), default=0)
        longest = longest_of([self.suspension(handle) for handle in excluded])
        return IterationPart(demand=demand, suspension=in_sequence([*map(self.suspension, always), longest]))

    def before(self, handle: Handle) -> IterationPart:
        """What an iteration does before a callback, after it has fixed what is ready; the take of its message included."""
        at = self.executor.handles.index(handle)
        earlier, later = self.executor.handles[:at], self.executor.handles[at + 1 :]
        found = self._part(*self._possible_with(handle, earlier), self.demand.spin.upper + self.demand.takes[handle.name].upper)
        if not self.executor.takes_first:
            return found
        always, excluded = self._possible_with(handle, later)
        takes = sum(self.demand.takes[each.name].upper for each in always)
        takes += max((self.demand.takes[each.name].upper for each in excluded), default=0)
        return IterationPart(demand=found.demand + takes, suspension=found.suspension)

    def _possible_with(self, handle: Handle, others: Sequence[Handle]) -> tuple[Sequence[Handle], Sequence[Handle]]:
        """Of some handles those that can all be ready together with another one, and those of which one can be."""
        if not self.takes_one:
            return others, ()
        always = [each for each in others if is_independent(each)]
        return always, [] if is_message(handle) else [each for each in others if not is_independent(each)]

    def until_start(self, handle: Handle) -> Time | None:
        """The longest time from when it is fixed what is ready to the start of a callback."""
        part = self.before(handle)
        return self.processor.time(part.demand, part.suspension.most, part.resumed)

    def until_end(self, handle: Handle) -> Time | None:
        """The longest time from when it is fixed what is ready to the end of a callback."""
        part, own = self.before(handle), self.suspension(handle)
        suspension = in_sequence([part.suspension, own])
        demand = part.demand + self.demand.callbacks[handle.name].upper
        return self.processor.time(demand, suspension.most, 1 + suspension.times)

    @cached_property
    def busy(self) -> Time | None:
        """The longest time to execute an iteration; None if it is not bounded."""
        return self.processor.time(self.whole.demand, self.whole.suspension.most, self.whole.resumed)

    @cached_property
    def longest(self) -> Time | None:
        """The longest cycle without a wait; None if it is not bounded."""
        return self.longest_with(0)

    @cached_property
    def longest_with_wait(self) -> Time | None:
        """The longest cycle with a wait that nothing ends before its timeout; None if it is not bounded."""
        return self.longest_with(longest_wait(self.executor))

    def in_sequence(self, wait: Time = 0) -> CycleSequence | None:
        """Cycles with some wait that follow each other; None if they are not bounded."""
        longest = self.longest_with(wait)
        if longest is None or not self._intervals:
            return None if longest is None else CycleSequence(longest, longest)
        usual = replace(self, others=self.usual_others).longest_with(wait)
        return CycleSequence(longest, longest if usual is None else usual, self._intervals)

    @cached_property
    def _intervals(self) -> tuple[Time, ...]:
        """The intervals of what the loop of the thread does in intervals of its own."""
        handles = (handle for each in self._others_of_thread for handle in each.handles)
        return tuple(handle.interval for handle in handles if _is_rare(handle) and handle.interval)

    def longest_with(self, wait: Time) -> Time | None:
        """The longest cycle with some wait, after which the thread has to get its core again; None if it is not bounded."""
        beginning = self._beginning(wait)
        if self._of_thread.suspension.most is None or self.busy is None or beginning is None:
            return None
        match self.executor.loop.kind:
            case LoopKind.PERIODIC:
                unslept, slept = self._awake(wait), (self.executor.loop.period or 0) + SLEEP_RESOLUTION + beginning
                return None if unslept is None else max(unslept, slept)
            case LoopKind.SLEEPING if self.sleep:
                bounds = [] if self.others else [self.sleep + self.busy + beginning]
                joint = self._awake(wait, self.sleep)
                return min([*bounds, *([] if joint is None else [joint])], default=None)
        return self._awake(wait)

    def _awake(self, wait: Time, sleep: Time = 0) -> Time | None:
        """The longest time for some wait and a whole iteration, and a sleep in it; None if it is not bounded."""
        part, suspended = self._of_thread, self._suspended(wait)
        if part.suspension.most is None or suspended is None:
            return None
        resumed = part.resumed + self._resumed(wait) + (1 if sleep else 0)
        return self.processor.time(part.demand, part.suspension.most + suspended + sleep, resumed)

    @property
    def can_overrun(self) -> bool:
        """Whether a wait and an iteration can take longer than the period of the loop."""
        if self.executor.loop.kind is not LoopKind.PERIODIC:
            return False
        awake = self._awake(longest_wait(self.executor))
        return awake is None or awake > (self.executor.loop.period or 0)

    @cached_property
    def _of_thread(self) -> IterationPart:
        """The longest iteration, and those of the other executors in the loop, with their waits."""
        parts = (self.whole, *self.others)
        return IterationPart(
            demand=sum(part.demand for part in parts), suspension=in_sequence([part.suspension for part in parts])
        )

    @property
    def _without_reading(self) -> Cycle:
        """Cycles in which no publication reads until its acknowledgement."""
        return self._calling(
            each
            for each in self.executor.handles
            if not any(reads_all(publication, self.sending, self.solved.context.system) for publication in each.publications)
        )

    @cached_property
    def longest_without_call(self) -> Time | None:
        """The longest cycle without a wait and without a callback; None if it is not bounded."""
        return self._calling(()).longest

    def _calling(self, handles: Iterable[Handle]) -> Cycle:
        """Cycles in which only some handles are called."""
        return replace(self, executor=replace(self.executor, handles=tuple(handles)))

    def _suspended(self, wait: Time) -> Time | None:
        """How long the beginning of an iteration is suspended, with some wait; None if it is not bounded."""
        times = self.session_wait, self.writing.most, self.again.most
        return None if None in times else wait + sum(filter(None, times))

    def _resumed(self, wait: Time) -> int:
        """How often the thread becomes ready after a suspension in it."""
        return (1 if self.session_wait else 0) + self.writing.times + self.again.times + (1 if wait else 0)

    def _beginning(self, wait: Time) -> Time | None:
        """The longest beginning of an iteration, with some wait; None if it is not bounded."""
        return self.processor.time(self.demand.spin.upper, self._suspended(wait), 1 + self._resumed(wait))

    @cached_property
    def until_check(self) -> Time | None:
        """The longest time from the arrival that ends a wait until it is fixed what is ready; None if it is not bounded."""
        return self._beginning(0)

    @cached_property
    def until_wait(self) -> Time | None:
        """The longest time from when it is fixed what is ready to the next wait; None if it is not bounded."""
        if self.executor.loop.kind is LoopKind.PERIODIC or self.others:
            return self.longest
        return None if self.busy is None else self.busy + self.sleep

    @cached_property
    def greatest_age(self) -> Time | None:
        """The greatest age of a message in the receive backlog, also if none is acknowledged; None if it has no bound."""
        return self.backlog_age if acknowledgements(self.solved.context.system) else self._backlog_age()

    @cached_property
    def shortest(self) -> Time:
        """The shortest cycle: nothing is called."""
        return self._shortest_besides + self._overhead.lower // self.time_base

    @cached_property
    def _shortest_besides(self) -> Time:
        """The least time that a cycle takes besides its iteration: all sleeps, and the overhead of the others in the loop."""
        overhead = sum(each.spin.lower + each.after.lower for each in self.other_demands.values())
        return sleep_of(self.executor).lower + overhead // self.time_base

    @property
    def _others_of_thread(self) -> Sequence[Executor]:
        return others_of_thread(self.executor, self.solved.context.system.executors)

    @property
    def _overhead(self) -> Interval[Time]:
        """The demand of every iteration, without callbacks."""
        spin, after = self.demand.spin, self.demand.after
        return Interval(spin.lower + after.lower, spin.upper + after.upper)

    @property
    def least_average(self) -> Time:
        """The time per cycle that a loop takes at least in the long run: one that catches up keeps its period on average."""
        return max(self.shortest, min_pace(self.executor), self.executor.loop.period or 0)

    @cached_property
    def shortest_with_message(self) -> Time:
        """The shortest cycle of an iteration that calls a callback for a message."""
        return min(map(self._shortest_executing, messages(self.executor)), default=self.shortest)

    def shortest_with(self, handle: Handle) -> Time:
        """The shortest time between two calls of a handle, from any instant in the first one to the same in the other."""
        return self._shortest_executing(handle) + self.suspension(handle).least

    def _shortest_executing(self, handle: Handle) -> Time:
        return self._shortest_besides + (self._overhead.lower + self.demand.of_handle(handle).lower) // self.time_base

    @property
    def most_served(self) -> int | None:
        """The most messages that an iteration calls callbacks for; None if a wait takes all that are there, or the trigger keeps them.

        A publication that waits reads all messages before its acknowledgement, and stores them: then each handle can have one.
        """
        if self.executor.waiting.messages_per_wait != 1 or can_defer(self.executor):
            return None
        return len(messages(self.executor)) if self.has_backlog else 1

    @property
    def unbounded(self) -> str:
        """Why the longest cycle is not bounded."""
        if self.session_wait is None or self._of_thread.suspension.most is None:
            why = self._of_thread.suspension.why or "the time for which other executors of its session keep it is unknown"
            return f"an iteration can be suspended without a bound: {why}"
        if self.writing.most is None or self.again.most is None:
            return f"a wait has no bound: {(self.writing if self.writing.most is None else self.again).why}"
        return "the processes that preempt it need nearly all of the core"


def _is_rare(handle: Handle) -> bool:
    """Whether a loop does something in an interval of its own."""
    return handle.kind is HandleKind.LOOP_ITEM and bool(handle.interval)


def _without_rare_items(executor: Executor) -> Executor:
    return replace(executor, handles=tuple(handle for handle in executor.handles if not _is_rare(handle)))


def _age_by(executor: Executor, solved: SolvedSystem, sending: Mapping[str, Span]) -> Time | None:
    """The greatest age of a message in the receive buffer that only one executor reads; None if there is no bound."""
    try:
        return Cycle.of(executor, solved, sending).backlog_age
    except UnknownError:
        return None
