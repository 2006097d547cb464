"""Systems as parts of a larger one: the same system with the name of the part before the names of its objects, and several joined."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import is_dataclass
from enum import Enum
from typing import Any, TypeVar

from amalthea_uros._internal.records import fields, replace
from amalthea_uros.perf.hardware import Feature
from amalthea_uros.perf.os import Parameter
from amalthea_uros.perf.system import System

T = TypeVar("T")

#: The models of a system.
_MODELS = ("hardware", "os", "stimuli", "software", "mapping", "events", "constraints", "network")

#: Fields whose texts name no object of a system: topics are the same for all controllers, others are literals or for people.
_NO_NAMES = frozenset(
    {
        *("topic", "publishes", "agent", "client", "assumptions", "policy", "needs"),
        *("value", "literals", "initial"),
        *("kind", "reason", "description", "origin"),
    }
)
#: Parts of the definition of a type or of a scheduling policy, whose words are the same everywhere.
_WORDS = (Feature, Parameter)


def qualified_name(part: str, name: str) -> str:
    """The name of an object of a part among those of the whole system."""
    return f"{part}_{name}"


def qualified(value: T, part: str) -> T:
    """A system, or something of it, with the name of the part before the names of objects."""
    new: Any = value
    if isinstance(new, str) and not isinstance(new, Enum):
        new = qualified_name(part, new) if new else new
    elif isinstance(new, tuple | frozenset):
        new = type(new)(qualified(each, part) for each in new)
    elif is_dataclass(new) and not isinstance(new, _WORDS):
        new = _renamed(new, part)
    return new  # type: ignore[no-any-return]


def _renamed(item: Any, part: str) -> Any:
    names = (each.name for each in fields(item) if each.init and each.name not in _NO_NAMES)
    return replace(item, **{name: qualified(getattr(item, name), part) for name in names})


def joined(parts: Mapping[str, System]) -> System:
    """Several systems as one; each object has the name of its part before its own name.

    Each part is a client of the middleware of its own.
    """
    systems = [qualified(_as_client(system, part), part) for part, system in parts.items()]
    agents = dict.fromkeys(each.network.agent for each in systems if each.network.wires)
    whole = System(
        executors=tuple(executor for each in systems for executor in each.executors),
        **{kind: _merged([getattr(each, kind) for each in systems]) for kind in _MODELS},
    )
    return replace(whole, network=replace(whole.network, agent=" and ".join(agents) or whole.network.agent))


def _as_client(system: System, part: str) -> System:
    """The system with the name of the part as that of its client, and in sentences about the times of its network."""
    network = system.network
    wires = tuple(replace(wire, client=part) for wire in network.wires)
    assumptions = tuple(f"{part}: {sentence}" for sentence in network.assumptions)
    return replace(
        system,
        executors=tuple(replace(each, client=part) for each in system.executors),
        network=replace(network, wires=wires, assumptions=assumptions),
    )


def _merged(models: Sequence[Any]) -> Any:
    """Several models of a kind as one: all objects of all of them."""
    lists = (each.name for each in fields(models[0]) if isinstance(getattr(models[0], each.name), tuple))
    return replace(models[0], **{name: tuple(item for each in models for item in getattr(each, name)) for name in lists})
