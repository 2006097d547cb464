"""The loop of a thread as a list: which executors spin in it, what it sleeps and waits for, and what nobody knows the time of.

What each executor of a thread needs to know: the sleeps of the whole loop, which pace it; those between its spin and the next one; and
what the thread waits for without sleeping there. A list that is rotated describes the same loop, so items before the first spin
follow the last one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.executors import LoopKind, ThreadLoop, ThreadPlace
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.spec.loops import LoopItem
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.os import OsSection
from amalthea_uros.units import MILLISECOND, Time
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.executors.sleeps import slept


@dataclass(frozen=True, slots=True)
class ThreadItems:
    """The items of the loop of a thread, the spin of its first executor first.

    Attributes
    ----------
    owner : the executor to whose section the list belongs
    """

    owner: str
    items: tuple[LoopItem, ...]

    @property
    def executors(self) -> tuple[str, ...]:
        """The executors that spin in it, in order."""
        return tuple(item.executor or self.owner for item in self.items if item.spin_some is not None)

    @property
    def unknown(self) -> str:
        """Why the time of the loop is unknown; "" if it is not."""
        sent = _sent_outside(self.items)
        return f"its loop also {sent}, which takes an unknown time" if sent else ""

    def loop(self, name: str, os: OsSection) -> ThreadLoop:
        """The loop as one of its executors has it: with all sleeps."""
        spin = next(item for item in self.items if item.spin_some is not None and (item.executor or self.owner) == name)
        sleeps = [slept(item.sleep, os) for item in self.items if item.sleep]
        least, most = sum(each.least for each in sleeps), sum(each.most for each in sleeps)
        # Of several sleeps, only that each is at least its shortest one counts.
        pace = sleeps[0].pace if len(sleeps) == 1 else 0
        return ThreadLoop(
            kind=LoopKind.SLEEPING,
            timeout=spin.spin_some or 0,
            sleep=most,
            sleep_early=most - least,
            pace=pace if pace > least else 0,
        )

    def place(self, name: str, os: OsSection) -> ThreadPlace | None:
        """The place of one of its executors; None if it is the only one."""
        if len(self.executors) < 2:
            return None
        sleeps = [slept(item.sleep, os) for item in self._after(name) if item.sleep]
        most = sum(each.most for each in sleeps)
        return ThreadPlace(thread=self.owner, sleep=most, sleep_early=most - sum(each.least for each in sleeps))

    def busy_wait(self, name: str, os: OsSection) -> Boundaries[Time] | None:
        """The time that the thread waits busily after the spin of an executor; None if there is nothing."""
        waits = [item.busy_wait for item in self._after(name) if item.busy_wait]
        return Boundaries(lower=sum(waits), upper=sum(_latest(each, os) for each in waits)) if waits else None

    def _after(self, name: str) -> Iterator[LoopItem]:
        """The items between the spin of an executor and the next spin."""
        spinning = self.executors[-1]
        for item in self.items:
            if item.spin_some is not None:
                spinning = item.executor or self.owner
            elif spinning == name:
                yield item


def why_unknown_time(name: str, middleware: Middleware) -> str:
    """Why the time of the loop of an executor is unknown: of what is sent outside of callbacks; "" if it is not."""
    items = thread_items(name, middleware)
    for each in middleware.stated_executors:
        if each.loop is not None and each.loop.only_sends:
            return f"the thread {each.name!r} {_sent_outside(each.loop.items or ())}, which delays it for an unknown time"
    return "" if items is None else items.unknown


def _sent_outside(items: Iterable[LoopItem]) -> str:
    return " and ".join(dict.fromkeys(text for item in items if (text := _unknown(item))))


def _unknown(item: LoopItem) -> str:
    if item.publish is not None:
        return f"publishes {', '.join(item.publish)} outside of callbacks"
    if item.ping is not None:
        return "pings the agent"
    return "synchronises its time with the agent" if item.sync is not None else ""


def _latest(wait: Time, os: OsSection) -> Time:
    """The longest time of a busy wait: those that count milliseconds wait for one tick more (`HAL_Delay` of the HAL of STM32)."""
    return wait if wait % MILLISECOND else wait + (MILLISECOND if os.tick is None else os.tick)


def thread_items(name: str, middleware: Middleware) -> ThreadItems | None:
    """The items of the loop that an executor spins in; None if no list describes it."""
    for each in middleware.stated_executors:
        items = each.loop.items if each.loop is not None else None
        if items is not None:
            thread = ThreadItems(each.name, tuple(items))
            if name in thread.executors:
                return thread
    return None


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
