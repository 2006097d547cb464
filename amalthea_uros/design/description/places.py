"""The keys of an `app.yaml` that state what `OBJECT.KEY=VALUE` changes."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property

from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.description.owners import Owner, OwnerKind, StatedTime, executors, owners
from amalthea_uros.design.description.text_edits import Path, Value
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import require
from amalthea_uros.spec.application import CallbackSection, MessageCallback, Timer
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.spec.processes import ProcessSection
from amalthea_uros.spec.transports import Interrupt
from amalthea_uros.units import SECOND, Time, data_size_text, parse_time, time_text
from amalthea_uros.uros.application import callbacks as uros
from amalthea_uros.uros.application.messages import Message
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.executor_runnables import message_cost, timer_count
from amalthea_uros.uros.assembly.planned import PriorityScale

_TICKS = re.compile(r"\d+\s*ticks?", re.ASCII)
#: Sections under other names than their own.
_PARTS = (OwnerKind.TAKE, OwnerKind.NOTIFY)
_WHOLE = re.compile(r"-?\d+", re.ASCII)


@dataclass(frozen=True, slots=True)
class Assignment:
    """A value for a key of a description.

    Attributes
    ----------
    target : the object and key that the user named
    instead_of : a key in whose place it is written
    """

    target: str
    path: Path
    value: Value
    instead_of: str | None = None


@dataclass(frozen=True)
class Places:
    """Finds the keys of changes in a description.

    Attributes
    ----------
    platform : the name of the hardware in execution times
    core_types : by core
    scale : what priorities of tasks mean in the description
    """

    description: Description
    platform: str | None
    core_types: Mapping[str, str]
    scale: PriorityScale

    def assignments(self, change: Change) -> list[Assignment]:
        """What has to be written for a change.

        Raises
        ------
        InvalidArgumentError : a description has no key for it.
        """
        if change.key == "memory":
            return list(self._memory(change))
        found = [owner for owner in self._owners(change.object) if change.key in _KEYS[owner.kind]]
        if not found:
            raise InvalidArgumentError(self._refusal(change))
        try:
            return [assignment for owner in found for assignment in _KEYS[owner.kind][change.key](self, owner, change)]
        except ValueError as error:
            raise InvalidArgumentError(f"{change}: {error}") from None

    def execution_time(self, name: str) -> list[StatedTime]:
        """Where the execution time of an object is stated; several places if several processes execute it.

        Raises
        ------
        InvalidArgumentError : it has none, or its parts are stated one by one.
        """
        found = [owner for owner in self._owners(name) if "execution_time" in _KEYS[owner.kind]]
        if not found:
            raise InvalidArgumentError(self._refusal(Change(name, "execution_time", "")))
        return [self._execution_time(owner) for owner in found]

    def knows(self, name: str) -> bool:
        """Whether the description has an object of a name."""
        return bool(self._owners(name))

    def _owners(self, name: str) -> Sequence[Owner]:
        return self._owners_by_name.get(name, ())

    # A calibration asks for hundreds of them.
    @cached_property
    def _owners_by_name(self) -> Mapping[str, Sequence[Owner]]:
        by_name = defaultdict[str, list[Owner]](list)
        for owner in owners(self.description):
            by_name[owner.name].append(owner)
        return by_name

    @cached_property
    def _owners_by_path(self) -> Mapping[Path, Sequence[Owner]]:
        by_path = defaultdict[Path, list[Owner]](list)
        for owner in owners(self.description):
            by_path[owner.path].append(owner)
        return by_path

    def _memory(self, change: Change) -> Iterable[Assignment]:
        """The memory of a label; a buffer that is not listed keeps the size of its messages."""
        path: Path = ("labels", change.object)
        sizes = {each.buffer: each.incoming.size for each in self.callbacks if each.incoming is not None}
        if change.object not in self.description.labels and change.object in sizes:
            yield Assignment(change.target, (*path, "size"), data_size_text(sizes[change.object]))
        yield Assignment(change.target, (*path, "memory"), change.value)

    def _refusal(self, change: Change) -> str:
        if change.key == "communication":
            return f"{change}: an app.yaml does not state how labels are communicated; write an AMALTHEA model (.amxmi) instead"
        if change.key == "frequency":
            return f"{change}: the execution times in an app.yaml are those at the present clock, so it is not written alone"
        kinds = dict.fromkeys(owner.kind for owner in self._owners(change.object))
        if not kinds:
            require("object of the description", [change.object], dict.fromkeys(o.name for o in owners(self.description)))
        keys = ", ".join(dict.fromkeys(key for kind in kinds for key in _KEYS[kind]))
        return f"{change}: an app.yaml has no {change.key!r} for the {' or '.join(kinds)} {change.object!r}; it has {keys}"

    def _execution_time(self, owner: Owner) -> StatedTime:
        section, path = owner.section, (*owner.path, "execution_time")
        if isinstance(section, ProcessSection) and section.runnables:
            names = ", ".join(f"{runnable.name}.execution_time" for runnable in section.runnables)
            raise InvalidArgumentError(f"the execution time of {owner.name!r} is that of its runnables; change {names}")
        if isinstance(section, ExecutorSection):
            path, time, elsewhere = self._spin(owner, section)
        elif owner.kind is OwnerKind.TAKE:
            path, time, elsewhere = self._take(owner)
        elif owner.kind is OwnerKind.NOTIFY:
            place, executor = self._serving(owner)
            path, time = (*place, "execution_time", "per_ready_callback"), executor.execution_time.per_ready_callback
            elsewhere = 0
        elif isinstance(section, Interrupt):
            is_mapping = section.location("execution_time") != section.location()
            path, time, elsewhere = path if is_mapping else owner.path, section.execution_time, 0
        else:
            time = getattr(section, "execution_time", None)
            elsewhere = self._publishing(section) if isinstance(section, CallbackSection) else 0
        if time is not None and time.on is not None:
            path, time = self._on(path, time, owner)
        return StatedTime(self._target(path), path, time, elsewhere)

    def _target(self, path: Path) -> str:
        """The object and the keys of a path."""
        nearest = next(held for end in range(len(path), -1, -1) if (held := self._owners_by_path.get(path[:end])))
        holder = max(nearest, key=lambda owner: owner.kind not in _PARTS)
        return ".".join(
            map(str, (getattr(holder.section, "name", holder.name), *(path[len(holder.path) :] or ["execution_time"])))
        )

    def _spin(self, owner: Owner, section: ExecutorSection) -> tuple[Path, ExecutionTimeSection | None, Time]:
        """The base of the cost of the executor, and its other parts in every activation."""
        cost, path = section.execution_time, (*owner.path, "execution_time")
        parts = [
            part for part in ("per_timer", "per_handle", "per_ready_callback", "per_message") if part in cost.model_fields_set
        ]
        if owner.kind is OwnerKind.EXECUTOR and parts:
            raise InvalidArgumentError(
                f"the execution time of {owner.name!r} has parts ({', '.join(['base', *parts])}), which are measured one by one"
            )
        is_mapping = "base" in cost.model_fields_set and cost.location("base") != cost.location()
        served = [each for each in self.callbacks if each.executor == section.name]
        checked = [*[cost.per_timer] * timer_count(served), *[cost.per_handle] * sum(each.handles for each in served)]
        return ((*path, "base") if is_mapping or parts else path), cost.base, _constant(checked, owner.name)

    def _serving(self, owner: Owner) -> tuple[Path, ExecutorSection]:
        """The executor that serves a callback, with its place."""
        name = next(each.executor for each in self.callbacks if each.section is owner.section)
        return next((place, executor) for place, executor in executors(self.description) if executor.name == name)

    def _take(self, owner: Owner) -> tuple[Path, ExecutionTimeSection | None, Time]:
        """The fixed part of the cost of a message, and the other parts that a callback's message has."""
        place, executor = self._serving(owner)
        cost = executor.execution_time
        incoming = next(each.incoming for each in self.callbacks if each.section is owner.section)
        assert incoming is not None
        others = _constant([cost.per_ready_callback, *message_cost(cost.per_message, incoming.size)[1:]], owner.name)
        path = (*place, "execution_time", "per_message")
        is_mapping = (
            cost.per_message.location() is not None and cost.per_message.location("fixed") != cost.per_message.location()
        )
        return ((*path, "fixed") if is_mapping else path), cost.per_message.fixed, others

    def _on(self, path: Path, time: ExecutionTimeSection, owner: Owner) -> tuple[Path, ExecutionTimeSection | None]:
        """The value of an execution time for this hardware."""
        assert time.on is not None
        core = str(getattr(owner.section, "core", None))
        types = [self.core_types[core]] if core in self.core_types else list(dict.fromkeys(self.core_types.values()))
        named = [name for name in (*types, self.platform) if name in time.on]
        if len(named) > 1:
            raise InvalidArgumentError(
                f"the execution time of {owner.name!r} depends on the core; change it in the description"
            )
        # The default is also that of other hardware, so this one gets a value of its own.
        name = named[0] if named else self.platform or "default"
        assert name is not None
        return (*path, "on", name), time.on.get(name, time.on.get("default"))

    def _publishing(self, section: CallbackSection) -> Time:
        """What publishing adds to the execution time of a callback."""
        sent = self._outgoing.get(id(section), ())
        publish = self.description.middleware.publish
        return _constant((part for message in sent for part in message_cost(publish, message.size)), section.name)

    @cached_property
    def _outgoing(self) -> Mapping[int, Sequence[Message]]:
        """The messages that callbacks publish, by the identities of their sections, which exist as long as the description."""
        return {id(each.section): each.outgoing for each in reversed(self.callbacks)}

    @cached_property
    def callbacks(self) -> tuple[uros.Callback, ...]:
        """The callbacks, with their intervals and messages."""
        return uros.callbacks_of(self.description.application, self.description.middleware, Notes())


def _constant(parts: Iterable[ExecutionTimeSection | Time | None], name: str) -> Time:
    """The sum of costs that do not vary.

    Raises
    ------
    InvalidArgumentError : one of them varies.
    """
    total = 0
    for part in parts:
        if isinstance(part, ExecutionTimeSection):
            if part.min is None or part.min != part.max or part.distribution is not None:
                raise InvalidArgumentError(f"a part of the execution time of {name!r} is stated elsewhere, and varies")
            total += part.min
        else:
            total += part or 0
    return total


_Write = Callable[[Places, Owner, Change], Iterable[Assignment]]


def _single(convert: Callable[[str], Value], key: str | None = None, instead_of: str | None = None) -> _Write:
    """The key of a section that states a change."""

    def write(_places: Places, owner: Owner, change: Change) -> Iterable[Assignment]:
        yield Assignment(change.target, (*owner.path, key or change.key), convert(change.value), instead_of)

    return write


def _time(text: str) -> str:
    return time_text(parse_time(text))


def _whole(text: str) -> int:
    if not _WHOLE.fullmatch(text):
        raise ValueError(f"{text!r} is not a whole number such as 2")
    return int(text)


def _word(text: str) -> str:
    return text


def _write_priority(places: Places, owner: Owner, change: Change) -> Iterable[Assignment]:
    yield Assignment(change.target, (*owner.path, "priority"), places.scale.number(_whole(change.value)))


def _names(text: str) -> list[str]:
    return [name for name in map(str.strip, text.split(",")) if name]


def _execution_time_ends(text: str) -> tuple[Time, Time]:
    """An execution time such as "12us" or "2us..4us"."""
    if _TICKS.search(text):
        raise ValueError("an app.yaml states execution times as times; write it as one, e.g. '12 us'")
    lower, separator, upper = text.partition("..")
    return parse_time(lower), parse_time(upper if separator else lower)


def _write_execution_time(places: Places, owner: Owner, change: Change) -> Iterable[Assignment]:
    stated = places._execution_time(owner)
    yield Assignment(change.target, stated.path, stated.bounds(*_execution_time_ends(change.value)))


def _write_arrival_period(_places: Places, owner: Owner, change: Change) -> Iterable[Assignment]:
    """The interval of messages; it is left as it is if it has the value."""
    section = owner.section
    assert isinstance(section, MessageCallback)
    stated = section.interval or (SECOND / section.rate if section.rate else None)
    if stated != parse_time(change.value):
        yield Assignment(change.target, (*owner.path, "interval"), _time(change.value), "rate")


def _write_timer_period(places: Places, owner: Owner, change: Change) -> Iterable[Assignment]:
    """A timer is due as often as its task is activated, unless the description says something else."""
    section, available = owner.section, places.description.middleware.task_periods
    assert isinstance(section, Timer)
    if available and parse_time(change.value) not in available:
        raise ValueError(f"{_time(change.value)} is not one of 'task_periods'")
    if section.task_period is not None:
        yield Assignment(change.target, (*owner.path, "task_period"), _time(change.value))
    if section.task_period is None or section.task_period == section.period:
        yield Assignment(change.target, (*owner.path, "period"), _time(change.value), "rate")


def _write_process_period(_places: Places, owner: Owner, change: Change) -> Iterable[Assignment]:
    section = owner.section
    assert isinstance(section, ProcessSection)
    for key in ("period", "burst", "times"):
        if getattr(section, key) is not None:
            path = (*owner.path, key) if key == "period" else (*owner.path, key, "period")
            yield Assignment(change.target, path, _time(change.value))
            return
    raise ValueError(f"{owner.name!r} is not activated periodically")


_SHARED: dict[str, _Write] = {
    "offset": _single(_time),
    "priority": _write_priority,
    "core": _single(_word),
    "deadline": _single(_time),
    "execution_time": _write_execution_time,
}
_CALLBACK: dict[str, _Write] = {
    **_SHARED,
    "phase": _single(_time),
    "runs_in": _single(_word),
    "runs_when": _single(_word),
}
_PROCESS: dict[str, _Write] = {**_SHARED, "period": _write_process_period, "jitter": _single(_time)}
_ONLY_EXECUTION_TIME: dict[str, _Write] = {"execution_time": _write_execution_time}

#: The keys of `OBJECT.KEY=VALUE` that a description can state, by the kind of the object.
_KEYS: Mapping[OwnerKind, Mapping[str, _Write]] = {
    OwnerKind.EXECUTOR: {
        **_SHARED,
        "period": _single(_time),
        "order": _single(_names),
        "semantics": _single(_word),
        "callbacks": _single(_word),
    },
    OwnerKind.SPIN: _ONLY_EXECUTION_TIME,
    OwnerKind.TAKE: _ONLY_EXECUTION_TIME,
    OwnerKind.NOTIFY: _ONLY_EXECUTION_TIME,
    OwnerKind.TIMER: {**_CALLBACK, "period": _write_timer_period},
    OwnerKind.MESSAGE_CALLBACK: {
        **_CALLBACK,
        "period": _single(_time, "task_period"),
        "arrival_period": _write_arrival_period,
        "arrival_jitter": _single(_time, "jitter"),
    },
    OwnerKind.BODY: _ONLY_EXECUTION_TIME,
    OwnerKind.TASK: {**_PROCESS, "preemption": _single(_word), "activation_limit": _single(_whole)},
    OwnerKind.ISR: {key: write for key, write in _PROCESS.items() if key != "deadline"} | {"priority": _single(_whole)},
    OwnerKind.RUNNABLE: _ONLY_EXECUTION_TIME,
    OwnerKind.INTERRUPT: {"execution_time": _write_execution_time, "priority": _single(_whole), "core": _single(_word)},
}
