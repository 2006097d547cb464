"""What may change of a system: the values on offer, the priorities, and the rules that designs must keep."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import StrEnum
from functools import cached_property
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.changes.apply import apply, check_key, describe
from amalthea_uros.design.changes.change import Change, Sweep, compact
from amalthea_uros.design.changes.key import UNSET, Configuration
from amalthea_uros.design.optimize.designs import Designs, RebuiltStructure
from amalthea_uros.design.optimize.rules import CapacityRule, rules
from amalthea_uros.design.optimize.space import Candidate, Choice, DecisionKind, PriorityOrder, Space
from amalthea_uros.design.optimize.stated_values import Source, is_stated, offered_values, structures
from amalthea_uros.design.optimize.structures import DescribedCallbacks
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import require
from amalthea_uros.perf.activities import AccessKind, Communication, LabelAccess
from amalthea_uros.perf.hardware import MemoryKind
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import known_releases
from amalthea_uros.timing.basics.settings import MemoryModel
from amalthea_uros.timing.jobs.executed import executed
from amalthea_uros.timing.scheduling.allocation import allocated_cores, is_by_priority, scheduler_cores
from amalthea_uros.units import time_text
from amalthea_uros.uros.assemble import Assembly


class Vary(StrEnum):
    """What of a system may change."""

    PERIODS = "periods"
    PRIORITIES = "priorities"
    OFFSETS = "offsets"
    CORES = "cores"
    CALLBACKS = "callbacks"
    ORDER = "order"
    COMMUNICATION = "communication"
    MEMORY = "memory"


#: Offsets of a process are tried in so many equal steps of its period.
OFFSET_STEPS = 10
#: What may change unless something else is asked for.
DEFAULT = (Vary.PERIODS, Vary.PRIORITIES)

_KINDS: Mapping[str, DecisionKind] = {
    "period": DecisionKind.PERIOD,
    "offset": DecisionKind.OFFSET,
    "priority": DecisionKind.PRIORITY,
    "core": DecisionKind.CORE,
    "scheduler": DecisionKind.CORE,
    "frequency": DecisionKind.CLOCK,
    "communication": DecisionKind.COMMUNICATION,
    "memory": DecisionKind.MEMORY,
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


def design_space(
    present: Configuration, wishes: Wishes, assembly: Assembly | None, source: Source | None
) -> tuple[Space, Designs]:
    """The space of designs, and what makes their systems.

    Parameters
    ----------
    assembly : of the description of the system; None if it has none
    source : the text of the description, or the model

    Raises
    ------
    InvalidArgumentError : an offer or something to keep does not exist, an offered value is wrong, or something cannot be varied.
    """
    stated_offers = () if source is None else tuple(each for each in wishes.offers if is_stated(each, source, assembly))
    builder = _Builder(assembly, present, wishes, stated_offers)
    described = (
        DescribedCallbacks.of(source)
        if (stated_offers and assembly is not None) or _needs_description(assembly, wishes)
        else None
    )
    _check_keep(wishes.keep, present.system, described)
    offered = () if source is None else tuple(offered_values(source, stated_offers))
    stated = offered if described is None else (*offered, *builder.stated_choices(described))
    orders = tuple(builder.orders())
    follows = wishes.is_rate_monotonic
    varies_priorities = Vary.PRIORITIES in wishes.vary and not follows
    space = Space(choices=(*builder.choices(), *stated), orders=orders if varies_priorities else ())

    def completed(changes: tuple[Change, ...], system: System, rebuilt: Assembly | None) -> RebuiltStructure:
        other = _Builder(rebuilt, present._replace(system=system), wishes, stated_offers)
        return RebuiltStructure(
            changes=changes,
            system=system,
            rules=tuple(rules(rebuilt, system)),
            rate_monotonic=tuple(other.orders()) if follows else (),
        )

    def build(own: Candidate) -> RebuiltStructure:
        if described is not None:
            return described.built(own, completed)
        assert source is not None, "nothing else states values"
        return completed(own, source.configure(own).system, None)

    designs = Designs(
        present=present,
        rules=tuple(rules(assembly, present.system)),
        rate_monotonic=orders if follows else (),
        stated={choice.target: choice.options[0] for choice in stated},
        structures=structures(stated, build),
    )
    return space, designs


def _needs_description(assembly: Assembly | None, wishes: Wishes) -> bool:
    """Whether something can change that only a description states: also the semantics of its executor, if it is one."""
    is_stated = {Vary.CALLBACKS, Vary.ORDER} & set(wishes.vary)
    return bool(is_stated) or (Vary.COMMUNICATION in wishes.vary and assembly is not None)


def _check_keep(keep: Iterable[str], system: System, source: DescribedCallbacks | None) -> None:
    """Refuse to keep what is not there; what only a description states is known if that can change."""
    stated = frozenset[str]() if source is None else source.targets
    callbacks = () if source is None else (callback.name for callback in source.callbacks)
    known = [*system.processes, *system.cores, *system.schedulers, *system.stimuli_by_name, *system.labels, *callbacks]
    for each in keep:
        if each not in known and each not in stated:
            name, _, key = each.rpartition(".")
            require("object to keep", [name or each], known)
            check_key(system, name, key)


class _LabelUse(NamedTuple):
    """A process that reads or writes a label."""

    process: str
    is_write: bool


@dataclass
class _Builder:
    assembly: Assembly | None
    present: Configuration
    wishes: Wishes
    stated_offers: tuple[Sweep, ...] = ()

    @property
    def system(self) -> System:
        """The system as it is."""
        return self.present.system

    # What may change

    def choices(self) -> Iterator[Choice]:
        """Single values; offers of the user replace what would be on offer by itself."""
        for offer in self.wishes.offers:
            if offer not in self.stated_offers:
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
            (Vary.COMMUNICATION, self._communications),
            (Vary.MEMORY, self._memories),
        ):
            if kind in self.wishes.vary:
                yield from choices()

    def _periods(self) -> Iterator[Choice]:
        """Shorter periods on offer: nobody stated that a process may run less often."""
        offered = () if self.assembly is None else self.assembly.task_periods
        for name, process in self.system.processes.items():
            releases = known_releases(process, self.system)
            if releases is not None:
                shorter = sorted((each for each in offered if each < releases.period), reverse=True)
                yield _choice(name, "period", DecisionKind.PERIOD, map(time_text, [releases.period, *shorter]))

    def _offsets(self) -> Iterator[Choice]:
        for name, process in self.system.processes.items():
            releases = known_releases(process, self.system)
            if releases is not None:
                step = releases.period // OFFSET_STEPS
                grid = [number * step for number in range(OFFSET_STEPS)] if step else []
                others = [offset for offset in grid if offset != releases.offset]
                yield _choice(name, "offset", DecisionKind.OFFSET, map(time_text, [releases.offset, *others]))

    def _cores(self) -> Iterator[Choice]:
        """Other schedulers of the same policy: by the names of their cores if each of them has one of its own.

        Tasks that nothing dispatches may be on any core that a single scheduler dispatches.
        """
        schedulers = self.system.schedulers
        dispatched = [core for name in schedulers if (core := self._own_core(name)) is not None]
        allocated = {each.task for each in self.system.mapping.tasks}
        for task in self.system.software.tasks:
            if task.name not in allocated:
                yield _choice(task.name, "core", DecisionKind.CORE, [UNSET, *dispatched])
        for allocation in self.system.mapping.tasks:
            own = schedulers.get(allocation.scheduler)
            if own is None:
                continue
            others = [
                name
                for name, each in schedulers.items()
                if each.policy == own.policy and each.parent is None and scheduler_cores(name, self.system) and name != own.name
            ]
            names = [own.name, *others]
            cores = [core for name in names if (core := self._own_core(name)) is not None]
            is_by_core = own.parent is None and len(cores) == len(names)
            yield _choice(
                allocation.task, "core" if is_by_core else "scheduler", DecisionKind.CORE, cores if is_by_core else names
            )

    def _own_core(self, scheduler: str) -> str | None:
        """The only core of a scheduler, if no other one is responsible for it."""
        cores = scheduler_cores(scheduler, self.system)
        if len(cores) != 1:
            return None
        shared = [name for name in self.system.schedulers if cores[0] in scheduler_cores(name, self.system)]
        return cores[0] if shared == [scheduler] else None

    def _communications(self) -> Iterator[Choice]:
        """Implicit or LET communication of each label that one process writes and another one reads."""
        if self.present.settings.communication is not None:
            raise InvalidArgumentError("the communication cannot vary if --communication sets it for all labels")
        for label in self.system.labels:
            uses = self._uses(label)
            if any(use.process != other.process for use in uses for other in uses if use.is_write > other.is_write):
                before = describe(*self.present, [Change(label, "communication", Communication.LET)])[0].before
                yield _choice(
                    label, "communication", DecisionKind.COMMUNICATION, [before, Communication.IMPLICIT, Communication.LET]
                )

    def _memories(self) -> Iterator[Choice]:
        """Other memories with known space, which all cores that need a label can access; no flash for what is written."""
        if self.present.settings.memory is MemoryModel.NONE:
            raise InvalidArgumentError(
                "the memory of a label has no effect without memory latencies; add --memory explicit or implicit"
            )
        cores, memories = allocated_cores(self.system), self.system.memories
        limited = {rule.memory for rule in rules(None, self.system) if isinstance(rule, CapacityRule)}
        for label in self.system.labels.values():
            uses, now = self._uses(label.name), self.system.memory_of.get(label.name)
            using = {core for use in uses for core in cores.get(use.process, ()) if core in self.system.cores}
            if now is not None and using and label.size is not None:
                reached = set.intersection(*({each.memory for each in self.system.cores[core].accesses} for core in using))
                is_written = any(use.is_write for use in uses)
                others = [
                    name
                    for name in memories
                    if name in reached & limited and not (is_written and memories[name].kind is MemoryKind.FLASH)
                ]
                yield _choice(label.name, "memory", DecisionKind.MEMORY, [now, *others])

    def _uses(self, label: str) -> Sequence[_LabelUse]:
        return self._uses_of_labels.get(label, ())

    @cached_property
    def _uses_of_labels(self) -> Mapping[str, Sequence[_LabelUse]]:
        """Which processes read and write each label."""
        found: dict[str, dict[_LabelUse, None]] = {}
        for name, process in self.system.processes.items():
            for activity in executed(process.activities, self.system):
                if isinstance(activity, LabelAccess):
                    use = _LabelUse(name, activity.kind is AccessKind.WRITE)
                    found.setdefault(activity.label, {})[use] = None
        return {label: tuple(uses) for label, uses in found.items()}

    # What only a description states

    def stated_choices(self, source: DescribedCallbacks) -> Iterator[Choice]:
        """Where callbacks run, in which order, and when they take their messages."""
        for kind, choices in (
            (Vary.CALLBACKS, source.placements),
            (Vary.ORDER, source.orders),
            (Vary.COMMUNICATION, source.semantics),
        ):
            if kind in self.wishes.vary:
                yield from (choice for choice in choices() if not self._is_kept(choice.object, choice.key))

    def _offered(self, offer: Sweep) -> Choice:
        target = f"{offer.object}.{offer.key}"
        if [(each.object, each.key) for each in self.wishes.offers].count((offer.object, offer.key)) > 1:
            raise InvalidArgumentError(f"{target!r} is on offer twice; offer all its values together")
        if self._is_kept(offer.object, offer.key):
            raise InvalidArgumentError(f"{target!r} is both on offer and kept")
        texts = [self._shown(change) for change in offer.changes()]
        before = describe(*self.present, [Change(offer.object, offer.key, offer.values[0])])[0].before
        return _choice(offer.object, offer.key, _KINDS.get(offer.key, DecisionKind.OTHER), [before, *texts])

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


def _choice(name: str, key: str, kind: DecisionKind, options: Iterable[str]) -> Choice:
    return Choice(object=name, key=key, kind=kind, options=tuple(dict.fromkeys(map(compact, options))))
