"""The loop of a thread as a list: its parts, at which executors spin or the thread itself sends, and what it waits for between them.

An executor of a thread needs to know: the sleeps of the whole loop, which pace it; those between its spin and the next one; and
what the thread waits for without sleeping there. Messages that the thread sends outside of callbacks are an executor, too: it waits
for nothing, and sends them in every iteration. A list that is rotated describes the same loop, so items before the first part follow
the last one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import count
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.executors import LoopKind, ThreadLoop, ThreadPlace
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.executors import ExecutorCost, ExecutorSection, TriggerSection
from amalthea_uros.spec.loops import LoopItem
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.os import OsSection
from amalthea_uros.units import MILLISECOND, Time
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.executors.sleeps import slept


class SentItem(NamedTuple):
    """What a loop sends outside of callbacks, with the name of the callback that stands for it."""

    name: str
    item: LoopItem


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopPart:
    """A place of a loop at which it waits or sends.

    Attributes
    ----------
    name : of the executor that spins, or that stands for what is sent
    timeout : of its wait
    sent : what the thread sends itself; nothing where an executor spins
    after : the sleeps and busy waits that follow
    """

    name: str
    timeout: Time = 0
    sent: tuple[SentItem, ...] = ()
    after: tuple[LoopItem, ...] = ()


@dataclass(frozen=True)
class ThreadItems:
    """The items of the loop of a thread.

    Attributes
    ----------
    owner : the executor to whose section the list belongs
    """

    owner: str
    items: tuple[LoopItem, ...]

    @cached_property
    def parts(self) -> tuple[LoopPart, ...]:
        """Its parts in order, that of its first executor first."""
        begins = [item.spin_some is not None for item in self.items]
        spins = any(begins)
        first = (begins if spins else [item.uses_agent for item in self.items]).index(True)
        groups: list[list[LoopItem]] = []
        for item in (*self.items[first:], *self.items[:first]):
            continues = not item.uses_agent or (groups and groups[-1][-1].uses_agent)
            if item.spin_some is None and continues:
                groups[-1].append(item)
            else:
                groups.append([item])
        senders, names = count(int(spins)), Counter[str]()
        return tuple(self._part_of(group, senders, names) for group in groups)

    def _part_of(self, items: Sequence[LoopItem], senders: Iterator[int], names: Counter[str]) -> LoopPart:
        """A part of its items: a spin or what is sent, then waits.

        Parameters
        ----------
        senders, names : the numbers of parts that send, and how often each name of an item was given
        """
        after = tuple(item for item in items if item.spin_some is None and not item.uses_agent)
        if items[0].spin_some is not None:
            return LoopPart(name=items[0].executor or self.owner, timeout=items[0].spin_some, after=after)
        sent = tuple(self._sent(item, names) for item in items if item.uses_agent)
        return LoopPart(name=self._name_of_sender(next(senders)), sent=sent, after=after)

    def _sent(self, item: LoopItem, names: Counter[str]) -> SentItem:
        own = f"{self.owner}_{_what(item)}"
        names[own] += 1
        return SentItem(own if names[own] == 1 else f"{own}_{names[own]}", item)

    def _name_of_sender(self, number: int) -> str:
        """The name of what sends, of several in the loop; where nothing spins, the first one has that of the section."""
        return self.owner if not number else f"{self.owner}_sends" if number == 1 else f"{self.owner}_sends_{number}"

    @property
    def executors(self) -> tuple[str, ...]:
        """The executors of its parts, in order."""
        return tuple(self._by_name)

    @cached_property
    def _by_name(self) -> Mapping[str, LoopPart]:
        return {each.name: each for each in self.parts}

    def pace(self, os: OsSection) -> Time:
        """The least time between two passes of the loop: its sleeps, in the long run."""
        return sum(slept(item.sleep, os).least for item in self.items if item.sleep)

    def loop(self, name: str, os: OsSection) -> ThreadLoop:
        """The loop as one of its executors has it: with all sleeps."""
        sleeps = [slept(item.sleep, os) for item in self.items if item.sleep]
        least, most = sum(each.least for each in sleeps), sum(each.most for each in sleeps)
        # Of several sleeps, only that each is at least its shortest one counts.
        pace = sleeps[0].pace if len(sleeps) == 1 else 0
        return ThreadLoop(
            kind=LoopKind.SLEEPING,
            timeout=self._part(name).timeout,
            sleep=most,
            sleep_early=most - least,
            pace=pace if pace > least else 0,
        )

    def place(self, name: str, os: OsSection) -> ThreadPlace | None:
        """The place of one of its executors; None if it is the only one."""
        if len(self.parts) < 2:
            return None
        sleeps = [slept(item.sleep, os) for item in self._part(name).after if item.sleep]
        most = sum(each.most for each in sleeps)
        return ThreadPlace(thread=self.owner, sleep=most, sleep_early=most - sum(each.least for each in sleeps))

    def busy_wait(self, name: str, os: OsSection) -> Boundaries[Time] | None:
        """The time that the thread waits busily after the spin of an executor; None if there is nothing."""
        waits = [item.busy_wait for item in self._part(name).after if item.busy_wait]
        return Boundaries(lower=sum(waits), upper=sum(_latest(each, os) for each in waits)) if waits else None

    def _part(self, name: str) -> LoopPart:
        return self._by_name[name]


def threads_with_items(middleware: Middleware) -> Iterator[ThreadItems]:
    """The threads whose loops are lists."""
    for each in middleware.stated_executors:
        items = each.loop.items if each.loop is not None else None
        if items is not None:
            yield ThreadItems(each.name, tuple(items))


def executors_of_loops(middleware: Middleware) -> dict[str, ExecutorSection]:
    """All executors by name: those that are stated, and those that stand for what loops send outside of callbacks."""
    sections = {each.name: each for each in middleware.stated_executors}
    for thread in threads_with_items(middleware):
        owner = sections[thread.owner]
        for part in thread.parts:
            if part.sent:
                sections[part.name] = _sending(owner, part.name)
    return sections


def names_of_loops(middleware: Middleware) -> Iterator[tuple[str, Location | None]]:
    """The names that what loops send gets, of executors and of callbacks, each with the place of the item."""
    for thread in threads_with_items(middleware):
        for part in thread.parts:
            if part.sent and part.name != thread.owner:
                yield part.name, part.sent[0].item.location()
            yield from ((each.name, each.item.location()) for each in part.sent)


def _sending(owner: ExecutorSection, name: str) -> ExecutorSection:
    """The executor that stands for messages which the thread of a section sends outside of callbacks; it costs nothing itself."""
    at_once = ExecutionTimeSection.model_construct(min=0, max=0)
    kept = {
        "name": name,
        "execution_time": ExecutorCost.model_construct(base=at_once),
        "trigger": TriggerSection.model_construct(when="always"),
        "order": [],
        "deadline": None,
        "semantics": "ROS",
        "max_handles": None,
    }
    return owner.model_copy(update=kept)


def _what(item: LoopItem) -> str:
    if item.publish is not None:
        return f"publishes_{item.publish[0]}"
    return "ping" if item.ping is not None else "sync"


def _latest(wait: Time, os: OsSection) -> Time:
    """The longest time of a busy wait: those that count milliseconds wait for one tick more (`HAL_Delay` of the HAL of STM32)."""
    return wait if wait % MILLISECOND else wait + (MILLISECOND if os.tick is None else os.tick)


def threads_by_executor(middleware: Middleware) -> Mapping[str, ThreadItems]:
    """The threads whose loops are lists, by the executors that are parts of them."""
    # An executor that two loops name, which is an error, is in the first one.
    return {name: each for each in reversed(list(threads_with_items(middleware))) for name in each.executors}


def in_thread_order(executors: Collection[str], threads: Mapping[str, ThreadItems]) -> list[str]:
    """Executors, with those of a thread in the order in which they spin."""
    order: dict[str, None] = {}
    for name in executors:
        if name not in order:
            order |= dict.fromkeys(threads[name].executors if name in threads else (name,))
    return [name for name in order if name in executors]


def threads_of(executors: Iterable[ExecutorSection], threads: Mapping[str, ThreadItems]) -> list[str]:
    """The threads in which executors spin, each once, by the names of their first executors."""
    return list(dict.fromkeys(threads[each.name].owner if each.name in threads else each.name for each in executors))


def check_threads_of_loops(middleware: Middleware, notes: Notes) -> None:
    """Report loops that name an executor which does not exist, or spins elsewhere."""
    stated = {each.name: each for each in middleware.executors or [middleware.executor]}
    taken: dict[str, str] = {}
    for owner in stated.values():
        for item in (owner.loop.items or ()) if owner.loop is not None else ():
            if item.executor is None:
                continue
            other = stated.get(item.executor)
            if other is None:
                notes.undefined("executor", item.executor, stated, item.location("executor"))
                continue
            again = taken.setdefault(item.executor, owner.name) != owner.name
            differs = [key for key in ("priority", "core") if other.states(key) and getattr(other, key) != getattr(owner, key)]
            if differs:
                message = f"{other.name!r} spins in the thread of {owner.name!r}, and has another {differs[0]}"
                notes.error(
                    "APP003", message, other.location(differs[0]), f"Remove {differs[0]!r}: that of {owner.name!r} holds."
                )
            if item.executor == owner.name or again or (other.states("loop") and not other.inherits("loop")):
                message = f"{item.executor!r} spins in the loop of {owner.name!r}, and elsewhere, too"
                advice = "Let an executor spin in one loop; one that spins in that of another executor has no 'loop'."
                notes.error("APP003", message, item.location("executor"), advice)
