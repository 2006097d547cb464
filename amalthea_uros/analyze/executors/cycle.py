"""The cycle of an executor: from the moment when it has fixed what is ready, after a wait, to the same moment of the next round.

Without the wait, a cycle consists of the rest of the round, what the loop does between two waits, and the beginning of the next round:

- `spin_some` with a sleep D: D + the time to execute a round
- `spin`: the time to execute a round
- `spin_period` with a period P: the invocation time is never later than the moment when the round began, and the thread sleeps until
  one period after it, or not at all. So it is at most the greater of P and the time to execute a round. As sleeps are cut to whole
  milliseconds, a round can begin up to 1 ms before its invocation time, which makes it 1 ms more.

A round executes the overhead of the executor once. Which part of it comes before the wait is unknown, so that its part after the
sleep can be all of it; the time of a cycle with a sleep is the lesser of two bounds: the sleep in the middle of one window, and two
windows.

A wait answers the heartbeats that are unread, whose number depends on the cycle: the least number that is consistent is the bound
(`unread`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from amalthea_uros.analyze.executors.unread import answered, is_behind, longest_unread, most_heartbeats
from amalthea_uros.analyze.executors.window import NoWindowError, Window
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.perf.executors import Executor, Handle, LoopKind
from amalthea_uros.perf.network import Span
from amalthea_uros.timing.executors.answers import Written, answering, answers, heartbeats
from amalthea_uros.timing.executors.loops import SLEEP_RESOLUTION, least_pace, least_sleep, longest_sleep
from amalthea_uros.timing.executors.readiness import at_once, is_exclusive, keeps_back, stores
from amalthea_uros.timing.executors.rounds import RoundCosts, round_costs
from amalthea_uros.timing.executors.sending import Suspension, suspension_of, together
from amalthea_uros.timing.executors.sessions import held_by_others
from amalthea_uros.timing.executors.wait import greatest_wait, is_message, messages
from amalthea_uros.timing.notes import UnknownDemandError
from amalthea_uros.units import Time

#: After which the number of heartbeats in a wait is considered unbounded.
_STEPS = 1000


class UnknownCycleError(Exception):
    """Nothing is known of the rounds of an executor; the text says why."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """What a thread does in a part of a round: execution in the time base of the core, suspensions in picoseconds."""

    demand: Time
    suspension: Suspension

    @property
    def resumed(self) -> int:
        """How often the thread becomes ready in it."""
        return 1 + self.suspension.times


@dataclass(frozen=True)
class Cycle:
    """The rounds of an executor.

    Attributes
    ----------
    sending : times of publications, by the names of transmissions
    is_exclusive : whether at most one handle that receives messages is ready in a round
    held : how long others can keep the session when it is needed
    answering : how long a wait is longer because it acknowledges what it reads
    unread : how long a message can lie unread; None if that has no bound, or nothing is answered
    """

    executor: Executor
    solution: Solution
    window: Window
    costs: RoundCosts
    sending: Mapping[str, Span]
    is_exclusive: bool
    held: Time | None
    answering: Suspension
    unread: Time | None = None

    @classmethod
    def of(cls, executor: Executor, solution: Solution, sending: Mapping[str, Span]) -> Cycle:
        """The rounds of an executor.

        Raises
        ------
        UnknownCycleError : its execution demand, or what can preempt it, is unknown.
        """
        system = solution.context.system
        try:
            cycle = cls(
                executor,
                solution,
                Window.of(executor.task, solution),
                round_costs(executor, solution.context),
                sending,
                is_exclusive(executor, system.executors),
                held=0,
                answering=Suspension(),
            )
        except (NoWindowError, UnknownDemandError) as error:
            raise UnknownCycleError(str(error)) from None
        return cycle._consistent()

    def _consistent(self) -> Cycle:
        """The cycle with the least number of what its wait writes."""
        written = Written()
        for _ in range(_STEPS):
            found = self._with(written)
            again = found._written()
            if again == written:
                return found
            written = again
        return self._with(Written(answers=None, heartbeats=None))

    def _with(self, written: Written) -> Cycle:
        system = self.solution.context.system
        found = replace(
            self,
            held=held_by_others(self.executor, system, self.sending, written),
            answering=answering(self.executor, system, self.sending, written),
        )
        if not answers(system):
            return found
        return replace(found, unread=longest_unread(found.longest, self.sending, self.solution))

    def _written(self) -> Written:
        """How often a wait writes, if the cycle is like this."""
        system = self.solution.context.system
        asked = [arriving for name, arriving in answered(self.solution).items() if system.transmissions[name].callback is None]
        unread = [None if each is None or self.unread is None else each.most(self.unread) for each in asked]
        return Written(answers=None if None in unread else sum(filter(None, unread)) + 1, heartbeats=self._heartbeats)

    @property
    def _heartbeats(self) -> int | None:
        """The heartbeats of the client in a wait: only if something can be sent and not be acknowledged then.

        They are an interval apart, and the timeout includes them, but for the last reading of it, whose time counts from its beginning.
        """
        if not heartbeats(self.solution.context.system) or not is_behind(self.sending, self.solution):
            return 0
        return most_heartbeats(greatest_wait(self.executor), self.solution)

    @property
    def time_base(self) -> int:
        """Time units per picosecond on the core."""
        return self.window.time_base

    @cached_property
    def stores(self) -> bool:
        """Whether messages can be stored before a round that takes them."""
        return stores(self.executor, self.solution.context.system.executors)

    @property
    def wait(self) -> Time:
        """The longest wait."""
        return greatest_wait(self.executor)

    @property
    def sleep(self) -> Time:
        """The sleep after each round."""
        return longest_sleep(self.executor)

    def suspension(self, handle: Handle) -> Suspension:
        """The suspension of a callback."""
        return suspension_of(handle, self.solution.context.system, self.sending, self.held)

    @cached_property
    def whole(self) -> Part:
        """The longest round: its overhead, and all callbacks that one round can call."""
        always = at_once(self.executor)
        excluded = [handle for handle in self.executor.handles if handle not in always]
        return self._part(always, excluded, self.costs.spin.worst)

    def _part(self, always: Sequence[Handle], excluded: Sequence[Handle], demand: Time) -> Part:
        """The demand of some handles; of those that exclude each other, the longest."""
        if not self.is_exclusive:
            always, excluded = (*always, *excluded), ()
        demand += sum(self.costs.of(handle).worst for handle in always)
        demand += max((self.costs.of(handle).worst for handle in excluded), default=0)
        return Part(demand=demand, suspension=together([*map(self.suspension, always), self._longest(excluded)]))

    def _longest(self, excluded: Iterable[Handle]) -> Suspension:
        """A suspension that bounds each of those of handles that exclude each other."""
        found = [self.suspension(handle) for handle in excluded]
        if not found:
            return Suspension()
        most = [each.most for each in found]
        return Suspension(
            most=None if None in most else max(each for each in most if each is not None),
            times=max(each.times for each in found),
            why="; ".join(dict.fromkeys(each.why for each in found if each.why)),
        )

    def before(self, handle: Handle) -> Part:
        """What a round does before a callback, after it has fixed what is ready; the take of its message included."""
        at = self.executor.handles.index(handle)
        earlier, later = self.executor.handles[:at], self.executor.handles[at + 1 :]
        found = self._part(*self._possible_with(handle, earlier), self.costs.spin.worst + self.costs.takes[handle.name].worst)
        if not self.executor.takes_first:
            return found
        always, excluded = self._possible_with(handle, later)
        takes = sum(self.costs.takes[each.name].worst for each in always)
        takes += max((self.costs.takes[each.name].worst for each in excluded), default=0)
        return Part(demand=found.demand + takes, suspension=found.suspension)

    def _possible_with(self, handle: Handle, others: Sequence[Handle]) -> tuple[Sequence[Handle], Sequence[Handle]]:
        """Of some handles those that can all be ready together with another one, and those of which one can be."""
        always = at_once(self.executor)
        excluded = [each for each in others if each not in always]
        if not self.is_exclusive:
            return others, ()
        return [each for each in others if each in always], [] if is_message(handle) else excluded

    def until_start(self, handle: Handle) -> Time | None:
        """The longest time from when it is fixed what is ready to the start of a callback."""
        part = self.before(handle)
        return self.window.time(part.demand, part.suspension.most, part.resumed)

    def until_end(self, handle: Handle) -> Time | None:
        """The longest time from when it is fixed what is ready to the end of a callback."""
        part, own = self.before(handle), self.suspension(handle)
        suspension = together([part.suspension, own])
        demand = part.demand + self.costs.callbacks[handle.name].worst
        return self.window.time(demand, suspension.most, 1 + suspension.times)

    @cached_property
    def busy(self) -> Time | None:
        """The longest time to execute a round; None if it is not bounded."""
        return self.window.time(self.whole.demand, self.whole.suspension.most, self.whole.resumed)

    @cached_property
    def longest(self) -> Time | None:
        """The longest cycle without a wait; None if it is not bounded."""
        return self.longest_with(0)

    @cached_property
    def longest_with_wait(self) -> Time | None:
        """The longest cycle with a wait that nothing ends before its timeout; None if it is not bounded."""
        return self.longest_with(self.wait)

    def longest_with(self, wait: Time) -> Time | None:
        """The longest cycle with some wait, after which the thread has to get its core again; None if it is not bounded."""
        part, held, answering = self.whole, self.held, self.answering
        if held is None or answering.most is None or part.suspension.most is None or self.busy is None:
            return None
        suspended, resumed = held + answering.most + wait, (1 if held else 0) + answering.times + (1 if wait else 0)
        beginning = self.window.time(self.costs.spin.worst, suspended, 1 + resumed)
        if beginning is None:
            return None
        together = part.suspension.most + suspended
        match self.executor.loop.kind:
            case LoopKind.SPIN_PERIOD:
                unslept = self.window.time(part.demand, together, part.resumed + resumed)
                slept = (self.executor.loop.period or 0) + SLEEP_RESOLUTION + beginning
                return None if unslept is None else max(unslept, slept)
            case LoopKind.SPIN_SOME if self.sleep:
                found = [self.sleep + self.busy + beginning]
                joint = self.window.time(part.demand, together + self.sleep, part.resumed + 1 + resumed)
                return min([*found, *([] if joint is None else [joint])])
        return self.window.time(part.demand, together, part.resumed + resumed)

    @cached_property
    def shortest(self) -> Time:
        """The shortest cycle: nothing is called."""
        return least_sleep(self.executor) + self.costs.spin.best // self.time_base

    @property
    def least_average(self) -> Time:
        """The time per cycle that a loop takes at least in the long run: one that catches up keeps its period on average."""
        return max(self.shortest, least_pace(self.executor), self.executor.loop.period or 0)

    @cached_property
    def shortest_with_message(self) -> Time:
        """The shortest cycle of a round that calls a callback for a message."""
        costs = [self.costs.of(handle).best for handle in self.executor.handles if is_message(handle)]
        return least_sleep(self.executor) + (self.costs.spin.best + min(costs, default=0)) // self.time_base

    @property
    def most_served(self) -> int | None:
        """The most messages that a round calls callbacks for; None if a wait takes all that are there, or the trigger keeps them.

        A publication that waits reads all messages before its acknowledgement, and stores them: then each handle can have one.
        """
        if self.executor.waiting.messages_per_wait != 1 or keeps_back(self.executor):
            return None
        return len(messages(self.executor)) if self.stores else 1

    @property
    def unbounded(self) -> str:
        """Why the longest cycle is not bounded."""
        if self.held is None or self.whole.suspension.most is None:
            why = self.whole.suspension.why or "how long others of its session keep it is unknown"
            return f"a round can be suspended without a bound: {why}"
        if self.answering.most is None:
            return f"a wait has no bound: {self.answering.why}"
        return "the processes that preempt it need nearly all of the core"
