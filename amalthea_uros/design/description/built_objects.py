"""The values of a description that decide about objects that are built from it, such as the runnable of a callback."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.description.assign import Assignment, Assignments
from amalthea_uros.design.description.keys import DescriptionKey, keys_of
from amalthea_uros.design.description.owners import Owner, OwnerKind, StatedTime, controllers_of, executors, owners
from amalthea_uros.design.description.text_edits import Path
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import require
from amalthea_uros.spec.application import CallbackSection, Timer
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.spec.processes import ProcessSection
from amalthea_uros.spec.transports import Interrupt
from amalthea_uros.units import Time, data_size_text, parse_time, time_text
from amalthea_uros.uros.application import callbacks as uros
from amalthea_uros.uros.application.messages import Message
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.executor_runnables import message_cost, timer_count
from amalthea_uros.uros.described import Described

_TICKS = re.compile(r"\d+\s*ticks?", re.ASCII)
#: Sections under other names than their own.
_PARTS = (OwnerKind.TAKE, OwnerKind.NOTIFY)
_WHOLE = re.compile(r"-?\d+", re.ASCII)
#: Runnables: of a section, they have the execution time alone.
_RUNNABLES = (OwnerKind.SPIN, OwnerKind.TAKE, OwnerKind.NOTIFY, OwnerKind.BODY, OwnerKind.RUNNABLE)
#: What sections call otherwise than systems do; by these names they have something else.
_OTHER_NAMES: Mapping[OwnerKind, Mapping[str, str]] = {
    OwnerKind.MESSAGE_CALLBACK: {"period": "task_period", "arrival_period": "interval", "arrival_jitter": "jitter"},
}
#: The processes whose priorities have the order of the operating system, not that of interrupts.
_SCHEDULED = (OwnerKind.EXECUTOR, OwnerKind.TIMER, OwnerKind.MESSAGE_CALLBACK, OwnerKind.TASK)


@dataclass(frozen=True)
class BuiltObjects:
    """Finds what states the values of processes, runnables and labels.

    Attributes
    ----------
    values : what is built from the description
    text : of the description
    place : of a controller of a robot in the text
    robot : that has the controller
    """

    values: Described
    text: str
    place: Path = ()
    robot: Described | None = None

    @property
    def description(self) -> Description:
        """The description as it is written."""
        return self.values.description

    def assignments(self, change: Change) -> Sequence[Assignment]:
        """The edits for a change.

        Raises
        ------
        InvalidArgumentError : a description has no key for it.
        """
        controller = self._controller_of(change.object)
        if controller is not None:
            objects, name = controller
            own = objects.assignments(replace(change, object=name))
            return [
                replace(each, target=change.target if each.target == f"{name}.{change.key}" else each.target) for each in own
            ]
        if change.key == "memory":
            return list(self._memory(change))
        holders = [owner for owner in self._owners(change.object) if self._has(owner, change.key)]
        if not holders:
            raise InvalidArgumentError(self._refusal(change))
        collected = Assignments(self.text, {})
        try:
            for owner in holders:
                self._add(collected, owner, change)
        except ValueError as error:
            raise InvalidArgumentError(f"{change}: {error}") from None
        return collected.every

    def _controller_of(self, name: str) -> tuple[BuiltObjects, str] | None:
        """The objects that are built from a controller of a robot, one of which has a name, and its name there; None if none has."""
        for index, section, own in controllers_of(name, self.description):
            described = self.values.controllers[section.name]
            objects = BuiltObjects(described, self.text, ("controllers", index), self.values)
            if section.file is None and (objects.knows(own) or own in described.assembly.system.labels):
                return objects, own
        return None

    def _add(self, collected: Assignments, owner: Owner, change: Change) -> None:
        if change.key == "execution_time":
            stated = self._execution_time(owner)
            written = stated.bounds(*_execution_time_ends(change.value))
            collected.written[stated.path] = Assignment(change.target, stated.path, written)
            return
        change = replace(change, value=self._number(owner, change))
        for path in self._paths(owner, change):
            if path in self._keys_by_path:
                collected.add(self._keys_by_path[path], change)
            else:  # a part of what is merged or shared, so that the edit is refused with the reason
                collected.written[path] = Assignment(change.target, path, change.value)

    def _has(self, owner: Owner, key: str) -> bool:
        """Whether a section states a value that a system calls so."""
        if key == "execution_time":
            return True
        names = _OTHER_NAMES.get(owner.kind, {})
        if owner.kind in _RUNNABLES or key in names.values():
            return False
        return names.get(key, key) in type(owner.section).model_fields

    def _paths(self, owner: Owner, change: Change) -> Iterator[Path]:
        """Where a value is in the text; nowhere if messages come as often as the description says."""
        section, path = owner.section, owner.path
        if change.key == "arrival_period" and parse_time(change.value) in (
            each.interval for each in self.callbacks if each.section is section
        ):
            return
        if change.key == "period" and isinstance(section, Timer):
            yield from self._timer_period(owner, change)
        elif change.key == "period" and isinstance(section, ProcessSection):
            activation = next((key for key in ("period", "burst", "times") if getattr(section, key) is not None), None)
            if activation is None:
                raise ValueError(f"{owner.name!r} is not activated periodically")
            yield (*path, "period") if activation == "period" else (*path, activation, "period")
        else:
            yield (*path, _OTHER_NAMES.get(owner.kind, {}).get(change.key, change.key))

    def _timer_period(self, owner: Owner, change: Change) -> Iterator[Path]:
        """A timer is due as often as its task is activated, unless the description says something else."""
        section, available = owner.section, self.description.middleware.task_periods
        assert isinstance(section, Timer)
        if available and parse_time(change.value) not in available:
            raise ValueError(f"{time_text(parse_time(change.value))} is not one of 'task_periods'")
        if section.task_period is not None:
            yield (*owner.path, "task_period")
        if section.task_period is None or section.task_period == section.period:
            yield (*owner.path, "period")

    def _number(self, owner: Owner, change: Change) -> str:
        """The value as the description writes it: priorities as the operating system counts them."""
        if change.key != "priority":
            return change.value
        if not _WHOLE.fullmatch(change.value):
            raise ValueError(f"{change.value!r} is not a whole number such as 2")
        return str(self.values.assembly.priority_scale.number(int(change.value))) if owner.kind in _SCHEDULED else change.value

    @cached_property
    def _keys_by_path(self) -> Mapping[Path, DescriptionKey]:
        return {key.path: key for key in keys_of((self.robot or self.values).whole, self.text)}

    def execution_time(self, name: str) -> list[StatedTime]:
        """Where the execution time of an object is stated; several places if several processes execute it.

        Raises
        ------
        InvalidArgumentError : it has none, or its parts are stated one by one.
        """
        controller = self._controller_of(name)
        if controller is not None:
            return controller[0].execution_time(controller[1])
        holders = self._owners(name)
        if not holders:
            raise InvalidArgumentError(self._refusal(Change(name, "execution_time", "")))
        return [self._execution_time(owner) for owner in holders]

    def knows(self, name: str) -> bool:
        """Whether the description has an object of a name."""
        return bool(self._owners(name))

    def _owners(self, name: str) -> Sequence[Owner]:
        return self._owners_by_name.get(name, ())

    # A calibration asks for hundreds of them.
    @cached_property
    def _owners_by_name(self) -> Mapping[str, Sequence[Owner]]:
        by_name = defaultdict[str, list[Owner]](list)
        for owner in self._every_owner():
            by_name[owner.name].append(owner)
        return by_name

    @cached_property
    def _owners_by_path(self) -> Mapping[Path, Sequence[Owner]]:
        by_path = defaultdict[Path, list[Owner]](list)
        for owner in self._every_owner():
            by_path[owner.path].append(owner)
        return by_path

    def _every_owner(self) -> Iterator[Owner]:
        return (replace(each, path=(*self.place, *each.path)) for each in owners(self.description))

    def _memory(self, change: Change) -> Iterable[Assignment]:
        """The memory of a label; a buffer that is not listed keeps the size of its messages."""
        path: Path = (*self.place, "labels", change.object)
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
        return f"{change}: an app.yaml has no {change.key!r} for the {' or '.join(kinds)} {change.object!r}"

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
        place, executor = next((place, each) for place, each in executors(self.description) if each.name == name)
        return (*self.place, *place), executor

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
        by_core = self.values.core_types
        types = [by_core[core]] if core in by_core else list(dict.fromkeys(by_core.values()))
        named = [name for name in (*types, self.values.platform) if name in time.on]
        if len(named) > 1:
            raise InvalidArgumentError(
                f"the execution time of {owner.name!r} depends on the core; change it in the description"
            )
        # The default is also that of other hardware, so this one gets a value of its own.
        name = named[0] if named else self.values.platform or "default"
        assert name is not None
        return (*path, "on", name), time.on.get(name, time.on.get("default"))

    def _publishing(self, section: CallbackSection) -> Time:
        """The part of publishing in the execution time of a callback."""
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


def _execution_time_ends(text: str) -> tuple[Time, Time]:
    """An execution time such as "12us" or "2us..4us"."""
    if _TICKS.search(text):
        raise ValueError("an app.yaml states execution times as times; write it as one, e.g. '12 us'")
    lower, separator, upper = text.partition("..")
    return parse_time(lower), parse_time(upper if separator else lower)
