"""Schedulers below others: their priority and deadline there, and the budget and period of servers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

from amalthea_uros.design.changes.key import OPERATING_SYSTEMS, UNSET, Configuration, Key
from amalthea_uros.design.changes.values import duration, positive_duration, whole_number
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.os import SERVERS, Duration, Parameter, Parent, Scheduler
from amalthea_uros.perf.system import System
from amalthea_uros.timing.scheduling.ranks import CAPACITY, PERIOD, standard_policy
from amalthea_uros.units import Time, time_text

V = TypeVar("V")


def _with_scheduler(configuration: Configuration, changed: Scheduler) -> Configuration:
    """The configuration with another scheduler of the same name."""
    system: System = configuration.system
    for operating_system in system.os.systems:
        schedulers = tuple(changed if each.name == changed.name else each for each in operating_system.schedulers)
        system = OPERATING_SYSTEMS.with_fields(system, operating_system.name, schedulers=schedulers)
    return configuration._replace(system=system)


def _parent_key(field: str, parse: Callable[[str], V], text: Callable[[V], str]) -> Key[V]:
    """The key for a field of the association with the parent."""

    def show(configuration: Configuration, name: str) -> str:
        value = getattr(configuration.system.schedulers[name].parent, field, None)
        return UNSET if value is None else text(value)

    def with_value(configuration: Configuration, name: str, value: V) -> Configuration:
        scheduler = configuration.system.schedulers[name]
        if scheduler.parent is None:
            raise InvalidArgumentError(f"the scheduler {name!r} has no parent, so it has no {field}")
        parent: Parent = replace(scheduler.parent, **{field: value})  # type: ignore[arg-type]
        return _with_scheduler(configuration, replace(scheduler, parent=parent))

    return Key(parse, show, with_value)


def _parameter_key(what: str, names: tuple[str, ...]) -> Key[Time]:
    """The key for a time of a server.

    Parameters
    ----------
    names : of the parameter; the first one is that of the newest version
    """

    def show(configuration: Configuration, name: str) -> str:
        scheduler = configuration.system.schedulers[name]
        stated = {parameter.name: parameter.values for parameter in _parameters(scheduler)}
        match next((stated[each] for each in names if each in stated), None):
            case (Duration(time),):
                return time_text(time)
        return UNSET

    def with_value(configuration: Configuration, name: str, value: Time) -> Configuration:
        scheduler = configuration.system.schedulers[name]
        if standard_policy(scheduler.policy) not in SERVERS:
            raise InvalidArgumentError(
                f"the scheduler {name!r} has no {what}: its policy {scheduler.policy} is not that of a server"
            )
        kept = tuple(each for each in scheduler.parameters if each.name not in names)
        parameter = Parameter(names[0], (Duration(value),))
        if scheduler.parent is None:
            return _with_scheduler(configuration, replace(scheduler, parameters=(*kept, parameter)))
        others = tuple(each for each in scheduler.parent.parameters if each.name not in names)
        parent = replace(scheduler.parent, parameters=(*others, parameter))
        return _with_scheduler(configuration, replace(scheduler, parameters=kept, parent=parent))

    return Key(positive_duration, show, with_value)


def _parameters(scheduler: Scheduler) -> tuple[Parameter, ...]:
    """The parameters of a scheduler; those of the association with its parent count more."""
    return (*scheduler.parameters, *(scheduler.parent.parameters if scheduler.parent else ()))


SCHEDULER_KEYS = {
    "priority": _parent_key("priority", whole_number, str),
    "deadline": _parent_key("deadline", duration, time_text),
    "capacity": _parameter_key("capacity", CAPACITY),
    "budget": _parameter_key("budget", CAPACITY),
    "period": _parameter_key("period", PERIOD),
}
