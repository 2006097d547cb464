"""Which constraints a random model gets: on events that have something to do with each other, and on others."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise, permutations
from random import Random

from opponent.models.chains import Chain, chains_of
from opponent.models.constraints import (
    ORDERS,
    Age,
    AgeInCycles,
    ChainSynchronization,
    Constraint,
    Delay,
    Deviation,
    EventOf,
    Order,
    Repetition,
    Synchronization,
)
from opponent.models.facts import period_of
from opponent.models.reading import Item, Played, Process, read
from opponent.models.variants import items_of_process

MICROSECOND = 10**6
#: How many constraints of a kind a model has at most.
MOST = 3


def constraints_of(text: str, rng: Random) -> tuple[Constraint, ...]:
    """Some constraints of each kind on what a model has."""
    played = read(text)
    chains = [chain for chain in chains_of(text, played) if not chain.branches]
    together = [
        ChainSynchronization(f"chains {end}", (one, other), end, _stimulus(one) == _stimulus(other), rng.random() < 0.5)
        for one, other in pairwise(chains)
        for end in ("Stimulus", "Response")
    ]
    return (*_Choice(played, rng).all(), *together)


def _stimulus(chain: Chain) -> tuple[str, str]:
    return chain.processes[0], chain.stimulus


class _Choice:
    def __init__(self, played: Played, rng: Random) -> None:
        self.played, self.rng = played, rng
        self.events = {process.name: list(self._events(process)) for process in played.processes}
        self.periods = {process.name: period_of(process, played) for process in played.processes}

    def _events(self, process: Process) -> Iterator[EventOf]:
        yield from (EventOf("process", process.name, change) for change in ("activate", "start", "terminate"))
        for item in dict.fromkeys(map(_called, items_of_process(self.played, process.name))):
            if item is not None:
                yield from (EventOf("runnable", item, change, process.name) for change in ("start", "terminate"))
        for access, label in self._explicit(process.name):
            yield EventOf("label", label, access, process.name)

    def _explicit(self, process: str) -> list[tuple[str, str]]:
        items = [item for item in items_of_process(self.played, process) if item[0] in ("read", "write")]
        return list(dict.fromkeys((str(item[0]), str(item[1])) for item in items if item[2] == "explicit"))

    def some(self, found: list[Constraint], most: int = MOST) -> list[Constraint]:
        """Some of those of a kind."""
        return self.rng.sample(found, min(most, len(found)))

    def all(self) -> Iterator[Constraint]:
        """Some of each kind."""
        yield from self._delays()
        yield from self._repetitions()
        yield from self._synchronizations()
        yield from self.some(list(self._ages()))
        yield from self.some(list(self._orders()))

    def _any(self) -> EventOf:
        return self.rng.choice(self.events[self.rng.choice([*self.events])])

    def _delays(self) -> Iterator[Constraint]:
        written = [
            (EventOf("label", label, "write", one), EventOf("label", label, "read", other))
            for one, other in permutations(self.events, 2)
            for access, label in self._explicit(one)
            if access == "write" and ("read", label) in self._explicit(other)
        ]
        for number in range(MOST + 1):
            mapping = self.rng.choice(("Reaction", "OneToOne", "UniqueReaction"))
            how = self.rng.choice(("data", "job", "job", "any"))
            if how == "data" and written:
                source, target = self.rng.choice(written)
            elif how != "any":
                source, target = self.rng.sample(self.events[self.rng.choice([*self.events])], 2)
            else:
                source, target = self._any(), self._any()
            if source != target:
                yield Delay(f"delay {number}", source, target, mapping)

    def _repetitions(self) -> Iterator[Constraint]:
        for number in range(MOST):
            yield Repetition(f"repetition {number}", self._any(), self.rng.choice((1, 1, 2)))
        periodic = [name for name, period in self.periods.items() if period]
        for name in self.rng.sample(periodic, min(2, len(periodic))):
            event, period = self.rng.choice(self.events[name]), self.periods[name]
            if period is not None:
                yield Deviation(f"deviation of {name}", event, period)

    def _synchronizations(self) -> Iterator[Constraint]:
        for number in range(MOST):
            first = self.rng.choice([*self.events])
            alike = [name for name, period in self.periods.items() if period == self.periods[first]]
            names = self.rng.sample(alike, min(len(alike), self.rng.choice((2, 2, 3))))
            events = tuple(self.rng.choice(self.events[name]) for name in names)
            if len(events) > 1:
                yield Synchronization(f"synchronization {number}", events, self.rng.random() < 0.5)

    def _ages(self) -> Iterator[Constraint]:
        """Of data that a runnable writes in one process, and nobody else."""
        writes = [
            (runnable, str(item[1]))
            for runnable, (body, _) in self.played.runnables.items()
            for item in body
            if item[0] == "write" and item[2] == "explicit"
        ]
        for runnable, label in dict.fromkeys(writes):
            writers = [name for name in self.events if ("write", label) in self._explicit(name)]
            others = [r for r, (body, _) in self.played.runnables.items() if any(i[:2] == ("write", label) for i in body)]
            plain = any(item[:2] == ("write", label) for process in self.played.processes for item in process.body)
            if len(writers) == 1 and others == [runnable] and not plain:
                yield Age(f"age of {label}", runnable, label, writers[0])
                yield AgeInCycles(f"age of {label} in cycles", runnable, label, writers[0])

    def _orders(self) -> Iterator[Constraint]:
        called = {name: [event.name for event in events if event.kind == "runnable"] for name, events in self.events.items()}
        kinds = {process.name: "ISR" if process.is_isr else "Task" for process in self.played.processes}
        for one, other in [*permutations(kinds, 2), *((name, name) for name in kinds)]:
            pairs = [(a, b) for a in dict.fromkeys(called[one]) for b in dict.fromkeys(called[other]) if a != b]
            for first, then in self.rng.sample(pairs, min(2, len(pairs))):
                kind = "successor" if one != other else self.rng.choice((ORDERS[0], *ORDERS))
                names = dict.fromkeys((one, other)) if self.rng.random() < 0.6 else ()
                scope = tuple((name, kinds[name]) for name in names)
                yield Order(f"order of {first} and {then} {len(scope)}", first, then, kind, scope)


def _called(item: Item) -> str | None:
    return str(item[1]) if item[0] == "call" else None
