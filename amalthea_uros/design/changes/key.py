"""What can be changed of an object, and where in a system it is."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from enum import StrEnum
from typing import Any, Generic, NamedTuple, TypeVar

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.software import Process, Task
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Frequency, Time, parse_frequency, parse_time

V = TypeVar("V")

#: The text of a value that a model leaves open.
UNSET = "not set"


class Configuration(NamedTuple):
    """A system and the settings that replace or add to its values."""

    system: System
    settings: Settings


@dataclass(frozen=True, slots=True)
class Key(Generic[V]):
    """A property of objects that can be changed.

    Attributes
    ----------
    parse : the value of a text; ValueError for a wrong one
    show : the present value of a named object, as text
    set : the configuration with another value for a named object; InvalidArgumentError if it has no place for one
    """

    parse: Callable[[str], V]
    show: Callable[[Configuration, str], str]
    set: Callable[[Configuration, str, V], Configuration]


@dataclass(frozen=True, slots=True)
class ChangeableKind:
    """Objects of a kind.

    Attributes
    ----------
    name : of the kind, for messages
    objects : the names of those in a system
    """

    name: str
    objects: Callable[[System], Iterable[str]]
    keys: Mapping[str, Key[Any]]


class Collection(NamedTuple):
    """Where the objects of a kind are in a system.

    Attributes
    ----------
    model : field of the system
    collection : field of the model
    identifier : field of the objects that has the name
    """

    model: str
    collection: str
    identifier: str = "name"

    def find(self, system: System, name: str) -> Any:
        """The object with a name, None if there is none."""
        items = getattr(getattr(system, self.model), self.collection)
        return next((item for item in items if getattr(item, self.identifier) == name), None)

    def with_fields(self, system: System, name: str, **fields: Any) -> System:
        """The system in which an object has other values."""
        return self.with_each(system, lambda item: replace(item, **fields) if getattr(item, self.identifier) == name else item)

    def with_each(self, system: System, change: Callable[[Any], Any]) -> System:
        """The system in which each object is what a function makes of it."""
        model: Any = getattr(system, self.model)
        items = tuple(map(change, getattr(model, self.collection)))
        parts: dict[str, Any] = {self.model: replace(model, **{self.collection: items})}
        return replace(system, **parts)

    def with_item(self, system: System, item: Any) -> System:
        """The system with one more object."""
        model: Any = getattr(system, self.model)
        parts: dict[str, Any] = {self.model: replace(model, **{self.collection: (*getattr(model, self.collection), item)})}
        return replace(system, **parts)


TASKS = Collection("software", "tasks")
ISRS = Collection("software", "isrs")
RUNNABLES = Collection("software", "runnables")
MODE_LABELS = Collection("software", "mode_labels")
STIMULI = Collection("stimuli", "stimuli")
CLOCKS = Collection("hardware", "clocks")
STRUCTURES = Collection("hardware", "structures")
OPERATING_SYSTEMS = Collection("os", "systems")
TASK_ALLOCATIONS = Collection("mapping", "tasks", "task")
ISR_ALLOCATIONS = Collection("mapping", "isrs", "isr")
PLACEMENTS = Collection("mapping", "placements", "element")


def process_place(process: Process) -> Collection:
    """Where a process is in a system."""
    return TASKS if isinstance(process, Task) else ISRS


def field_key(place: Collection, field: str, parse: Callable[[str], V], text: Callable[[V], str] = str) -> Key[V]:
    """The key for a field of the objects at a place."""

    def show(configuration: Configuration, name: str) -> str:
        value = getattr(place.find(configuration.system, name), field, None)
        return UNSET if value is None else text(value)

    def with_value(configuration: Configuration, name: str, value: V) -> Configuration:
        if place.find(configuration.system, name) is None:
            raise InvalidArgumentError(f"{name!r} is not mapped to a scheduler or interrupt controller, so it has no {field}")
        fields: dict[str, Any] = {field: value}
        return configuration._replace(system=place.with_fields(configuration.system, name, **fields))

    return Key(parse, show, with_value)


def unused(name: str, names: Iterable[str]) -> str:
    """A name that no other object has: the wanted one, with an underscore for each object that has it."""
    taken = set(names)
    while name in taken:
        name += "_"
    return name


E = TypeVar("E", bound=StrEnum)


def duration(text: str) -> Time:
    """A time of at least 0."""
    time = parse_time(text)
    if time < 0:
        raise ValueError(f"{text!r} is negative; expected at least 0 s")
    return time


def positive_duration(text: str) -> Time:
    """A time greater than 0."""
    time = parse_time(text)
    if time <= 0:
        raise ValueError(f"{text!r} is not greater than 0 s")
    return time


def positive_frequency(text: str) -> Frequency:
    """A frequency greater than 0."""
    frequency = parse_frequency(text)
    if frequency <= 0:
        raise ValueError(f"{text!r} is not greater than 0 Hz")
    return frequency


def whole_number(text: str) -> int:
    """A whole number."""
    try:
        return int(text)
    except ValueError:
        raise ValueError(f"{text!r} is not a whole number such as 2") from None


def positive_number(text: str) -> int:
    """A whole number of at least 1."""
    number = whole_number(text)
    if number < 1:
        raise ValueError(f"{text!r} is less than 1")
    return number


def one_of(members: Iterable[E]) -> Callable[[str], E]:
    """One of some words."""
    choices = {str(member): member for member in members}

    def choose(text: str) -> E:
        if text not in choices:
            raise ValueError(f"{text!r} is not one of {', '.join(choices)}")
        return choices[text]

    return choose
