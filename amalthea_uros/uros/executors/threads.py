"""The loop of a thread as a list: its parts, at which executors spin or the thread itself sends, and what it waits for between them.

An executor of a thread needs to know: the sleeps of the whole loop, which pace it; those between its spin and the next one; and
what the thread waits for without sleeping there. Messages that the thread sends outside of callbacks are an executor, too: it waits
for nothing, and sends them in every iteration. A list that is rotated describes the same loop, so items before the first part follow
the last one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass, replace
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


@dataclass(frozen=True, slots=True)
class ThreadItems:
    """The items of the loop of a thread.

    Attributes
    ----------
    owner : the executor to whose section the list belongs
    """

    owner: str
    items: tuple[LoopItem, ...]

    @property
    def parts(self) -> tuple[LoopPart, ...]:
        """Its parts in order, that of its first executor first."""
        begins = [item.spin_some is not None for item in self.items]
        spins = any(begins)
        first = (begins if spins else [item.uses_agent for item in self.items]).index(True)
        parts: list[LoopPart] = []
        names: Counter[str] = Counter()
        for item in (*self.items[first:], *self.items[:first]):
            if item.spin_some is not None:
                parts.append(LoopPart(name=item.executor or self.owner, timeout=item.spin_some))
            elif not item.uses_agent:
                parts[-1] = replace(parts[-1], after=(*parts[-1].after, item))
            else:
                own = f"{self.owner}_{_what(item)}"
                names[own] += 1
                sent = SentItem(own if names[own] == 1 else f"{own}_{names[own]}", item)
                if parts and parts[-1].sent and not parts[-1].after:
                    parts[-1] = replace(parts[-1], sent=(*parts[-1].sent, sent))
                else:
                    number = sum(bool(each.sent) for each in parts) + spins
                    parts.append(LoopPart(name=self._name_of_sender(number), sent=(sent,)))
        return tuple(parts)

    def _name_of_sender(self, number: int) -> str:
        """The name of what sends, of several in the loop; where nothing spins, the first one has that of the section."""
        return self.owner if not number else f"{self.owner}_sends" if number == 1 else f"{self.owner}_sends_{number}"

    @property
    def executors(self) -> tuple[str, ...]:
        """The executors of its parts, in order."""
        return tuple(each.name for each in self.parts)

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
        return next(each for each in self.parts if each.name == name)


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


def thread_items(name: str, middleware: Middleware) -> ThreadItems | None:
    """The items of the loop that an executor is a part of; None if no list describes it."""
    return next((each for each in threads_with_items(middleware) if name in each.executors), None)


def in_thread_order(executors: Sequence[str], middleware: Middleware) -> list[str]:
    """Executors, with those of a thread in the order in which they spin."""
    order: dict[str, None] = {}
    for name in executors:
        items = thread_items(name, middleware)
        order |= dict.fromkeys((name,) if items is None else items.executors)
    return [name for name in order if name in executors]


def threads_of(executors: Sequence[ExecutorSection], middleware: Middleware) -> list[str]:
    """The threads in which executors spin, each once, by the names of their first executors."""
    names = (each.name for each in executors)
    return list(dict.fromkeys(name if (items := thread_items(name, middleware)) is None else items.owner for name in names))


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
