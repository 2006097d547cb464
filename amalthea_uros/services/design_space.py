"""What may change of a system: the values on offer, the priorities, and the rules that designs must keep."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

from amalthea_uros.changes.apply import apply, check_key, describe
from amalthea_uros.changes.change import Change
from amalthea_uros.changes.key import UNSET, Configuration
from amalthea_uros.changes.sweep import Sweep
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import require
from amalthea_uros.optimize.designs import Designs, PeriodRule
from amalthea_uros.optimize.space import Choice, Kind, PriorityOrder, Space
from amalthea_uros.perf.activities import Call, walk
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.services.inputs import SystemInput
from amalthea_uros.timing.allocation import scheduler_cores
from amalthea_uros.timing.arrivals import nominal_period
from amalthea_uros.timing.phases import counters
from amalthea_uros.timing.releases import known_releases
from amalthea_uros.timing.scheduling import is_by_priority
from amalthea_uros.units import Time, time_text


class Vary(StrEnum):
    """What of a system may change."""

    PERIODS = "periods"
    PRIORITIES = "priorities"
    OFFSETS = "offsets"
    CORES = "cores"


#: Offsets of a process are tried in so many equal steps of its period.
OFFSET_STEPS = 10
#: What may change unless something else is asked for.
DEFAULT = (Vary.PERIODS, Vary.PRIORITIES)

_KINDS: Mapping[str, Kind] = {
    "period": Kind.PERIOD,
    "offset": Kind.OFFSET,
    "priority": Kind.PRIORITY,
    "core": Kind.CORE,
    "scheduler": Kind.CORE,
    "frequency": Kind.CLOCK,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Wishes:
    """What the user says about the space.

    Attributes
    ----------
    offers : further values of single properties
    keep : objects, or their properties as `OBJECT.KEY`, that must not change
    is_rate_monotonic : whether priorities follow the periods, instead of being varied
    """

    vary: tuple[Vary, ...] = DEFAULT
    offers: tuple[Sweep, ...] = ()
    keep: tuple[str, ...] = ()
    is_rate_monotonic: bool = False


def design_space(opened: SystemInput, present: Configuration, wishes: Wishes) -> tuple[Space, Designs]:
    """The space of designs, and what makes their systems.

    Raises
    ------
    InvalidArgumentError : an offer or something to keep does not exist, or an offered value is wrong.
    """
    _check_keep(wishes.keep, present.system)
    builder = _Builder(opened, present, wishes)
    orders = tuple(builder.orders())
    follows = wishes.is_rate_monotonic
    varies_priorities = Vary.PRIORITIES in wishes.vary and not follows
    space = Space(choices=tuple(builder.choices()), orders=orders if varies_priorities else ())
    designs = Designs(present=present, rules=tuple(builder.rules()), rate_monotonic=orders if follows else ())
    return space, designs


def _check_keep(keep: Iterable[str], system: System) -> None:
    known = [*system.processes, *system.cores, *system.schedulers, *system.stimuli_by_name]
    for each in keep:
        if each not in known:
            name, _, key = each.rpartition(".")
            require("object to keep", [name or each], known)
            check_key(system, name, key)


@dataclass(slots=True)
class _Builder:
    opened: SystemInput
    present: Configuration
    wishes: Wishes

    @property
    def system(self) -> System:
        """The system as it is."""
        return self.present.system

    # What may change

    def choices(self) -> Iterator[Choice]:
        """Single values; offers of the user replace what would be on offer by itself."""
        for offer in self.wishes.offers:
            yield self._offered(offer)
        for choice in self._own_choices():
            if self._is_free(choice.object, choice.key) and len(choice.options) > 1:
                yield choice

    def orders(self) -> Iterator[PriorityOrder]:
        """The priorities of each scheduler that serves the highest priority first, if they are distinct."""
        for name, scheduler in self.system.schedulers.items():
            if not is_by_priority(scheduler.policy) or name in self.wishes.keep:
                continue
            tasks = [
                (each.priority, each.task)
                for each in self.system.mapping.tasks
                if each.scheduler == name and each.priority is not None and self._is_free(each.task, "priority")
            ]
            ordered = sorted(tasks, key=lambda pair: -pair[0])
            numbers = tuple(number for number, _ in ordered)
            if len(set(numbers)) == len(numbers) > 1:
                yield PriorityOrder(scheduler=name, tasks=tuple(task for _, task in ordered), numbers=numbers)

    def _own_choices(self) -> Iterator[Choice]:
        for kind, choices in (
            (Vary.PERIODS, self._periods),
            (Vary.OFFSETS, self._offsets),
            (Vary.CORES, self._cores),
        ):
            if kind in self.wishes.vary:
                yield from choices()

    def _periods(self) -> Iterator[Choice]:
        """Shorter periods on offer: nobody stated that a process may run less often."""
        for name, process in self.system.processes.items():
            releases = known_releases(process, self.system)
            if releases is not None:
                shorter = sorted((each for each in self.opened.task_periods if each < releases.period), reverse=True)
                yield _choice(name, "period", Kind.PERIOD, map(time_text, [releases.period, *shorter]))

    def _offsets(self) -> Iterator[Choice]:
        for name, process in self.system.processes.items():
            releases = known_releases(process, self.system)
            if releases is not None:
                step = releases.period // OFFSET_STEPS
                grid = [number * step for number in range(OFFSET_STEPS)] if step else []
                others = [offset for offset in grid if offset != releases.offset]
                yield _choice(name, "offset", Kind.OFFSET, map(time_text, [releases.offset, *others]))

    def _cores(self) -> Iterator[Choice]:
        """Other schedulers of the same policy."""
        schedulers = self.system.schedulers
        for allocation in self.system.mapping.tasks:
            own = schedulers.get(allocation.scheduler)
            if own is not None:
                others = [
                    name
                    for name, each in schedulers.items()
                    if each.policy == own.policy
                    and each.parent is None
                    and scheduler_cores(name, self.system)
                    and name != own.name
                ]
                yield _choice(allocation.task, "scheduler", Kind.CORE, [own.name, *others])

    def _offered(self, offer: Sweep) -> Choice:
        target = f"{offer.object}.{offer.key}"
        if [(each.object, each.key) for each in self.wishes.offers].count((offer.object, offer.key)) > 1:
            raise InvalidArgumentError(f"{target!r} is on offer twice; offer all its values together")
        if self._is_kept(offer.object, offer.key):
            raise InvalidArgumentError(f"{target!r} is both on offer and kept")
        texts = [self._shown(change) for change in offer.changes()]
        before = describe(*self.present, [Change(offer.object, offer.key, offer.values[0])])[0].before
        if before == UNSET:
            return _choice(offer.object, offer.key, _KINDS.get(offer.key, Kind.OTHER), texts)
        return _choice(offer.object, offer.key, _KINDS.get(offer.key, Kind.OTHER), [before, *texts])

    def _shown(self, change: Change) -> str:
        """The value of a change as the system shows it, so that equal values are one option."""
        apply(*self.present, [change])
        after = describe(*self.present, [change])[0].after
        return change.value if after == UNSET else after

    def _is_free(self, name: str, key: str) -> bool:
        """Whether the user neither keeps a property nor offers values of it."""
        return not self._is_kept(name, key) and (name, key) not in {(each.object, each.key) for each in self.wishes.offers}

    def _is_kept(self, name: str, key: str) -> bool:
        return name in self.wishes.keep or f"{name}.{key}" in self.wishes.keep

    # Rules

    def rules(self) -> Iterator[PeriodRule]:
        """The rules of the middleware for periods, as far as the system is that of a description; see `uros.periods`."""
        if self.opened.assembly is None or not self.opened.assembly.choices:
            return
        executor, *others = (choice.task for choice in self.opened.assembly.choices)
        callbacks = tuple(name for name in others if name in self.system.processes)
        if executor in self.system.processes and callbacks:
            yield PeriodRule(process=executor, others=callbacks, text=f"{executor} runs less often than the fastest callback")
        intervals = self._message_intervals()
        for name in callbacks:
            if (interval := intervals.get(name)) is not None:
                text = f"{name} runs less often than messages arrive, every {time_text(interval)}"
                yield PeriodRule(process=name, longest=interval, text=text)

    def _message_intervals(self) -> Mapping[str, Time]:
        """How often the messages arrive that processes handle."""
        found: dict[str, Time] = {}
        for taker, counter in counters(self.system):
            interval = nominal_period(self.system.processes[taker], counter, self.system)
            if counter.source and interval is not None:
                for name, process in self.system.processes.items():
                    if name == counter.source or counter.source in _runnables(process):
                        found[name] = min(interval, found.get(name, interval))
        return found


def _runnables(process: Process) -> set[str]:
    return {activity.runnable for activity in walk(process.activities) if isinstance(activity, Call)}


def _choice(name: str, key: str, kind: Kind, options: Iterable[str]) -> Choice:
    texts: Sequence[str] = [text.replace(" ", "") for text in options]
    return Choice(object=name, key=key, kind=kind, options=tuple(dict.fromkeys(texts)))
