"""Executors, the network and the host, as custom properties: AMALTHEA has no classes for them.

An executor is a property of the task that executes its rounds, a transmission of the task that stands for it, and the wires and the
host are properties of the software model. Other tools ignore them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any, TypeVar

from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.json_text import from_text, to_text
from amalthea_uros.bridge.basics.kinds import ObjectKind
from amalthea_uros.bridge.basics.middleware_flaws import (
    flaw_of_executor,
    flaw_of_host,
    flaw_of_network,
    flaw_of_transmission,
    has_old_topic,
    with_unknown_activation,
)
from amalthea_uros.errors import UnknownError
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.host import Host
from amalthea_uros.perf.network import Network, Purpose, Transmission
from amalthea_uros.perf.system import System

T = TypeVar("T")

_EXECUTOR, _TRANSMISSION, _NETWORK = "amuros.executor", "amuros.transmission", "amuros.network"
_HOST = "amuros.host"


def build_middleware(system: System, software: am.SWModel, context: Building) -> None:
    """Set the properties of all executors, of the network and of the host."""
    for executor in system.executors:
        context.at(executor)
        _attach(context.find(ObjectKind.PROCESS, executor.task), _EXECUTOR, to_text(executor, without=("task",)))
    for transmission in system.network.transmissions:
        context.at(transmission)
        _attach(context.find(ObjectKind.PROCESS, transmission.name), _TRANSMISSION, to_text(transmission, without=("name",)))
    network = replace(system.network, transmissions=())
    if network != Network():
        _attach(software, _NETWORK, to_text(network))
    if system.host != Host():
        _attach(software, _HOST, to_text(system.host))


def _attach(element: Any, key: str, text: str) -> None:
    if element is not None:
        element.custom_properties.append(am.CustomProperty(key=key, value=am.StringObject(value=text)))


def extract_executors(tasks: Iterable[am.Task], system: System, context: Extracting) -> tuple[Executor, ...]:
    """The executors of the tasks; those that refer to something that the system has not are left out, with a finding."""
    return tuple(
        _extracted(tasks, _EXECUTOR, partial(_executor, context), lambda found: flaw_of_executor(found, system), context)
    )


def _executor(context: Extracting, task: Element, text: str) -> Executor:
    return from_text(Executor, text, task=context.names[task], origin=partial(context.location, task))


def extract_network(models: Iterable[am.SWModel], tasks: Iterable[am.Task], system: System, context: Extracting) -> Network:
    """The network of all files; what refers to something that the system has not is left out, with a finding."""
    found = list(
        _extracted(
            models,
            _NETWORK,
            lambda _, text: from_text(Network, text),
            lambda network: flaw_of_network(network, system),
            context,
        )
    )
    network = Network()
    if found:
        wires = tuple(wire for each in found for wire in each.wires)
        network = Network(
            wires=wires,
            agent=found[-1].agent,
            waits=tuple(wait for each in found for wait in each.waits),
            assumptions=tuple(dict.fromkeys(sentence for each in found for sentence in each.assumptions)),
        )
    transmissions = _extracted(
        tasks,
        _TRANSMISSION,
        partial(_transmission, context),
        lambda each: flaw_of_transmission(each, network, system),
        context,
    )
    return replace(network, transmissions=tuple(map(_with_acknowledged, transmissions)))


def _transmission(context: Extracting, task: Element, text: str) -> Transmission:
    found = from_text(Transmission, text, name=context.names[task], origin=partial(context.location, task))
    if has_old_topic(found):
        message = f"the message {found.name!r} has the topic {found.topic!r}, which no longer is that of requests and responses"
        context.note("EXT006", message, task)
    return found


def extract_host(models: Iterable[am.SWModel], context: Extracting) -> Host:
    """The host; the one of the last file that has one."""
    hosts = list(_extracted(models, _HOST, lambda _, text: from_text(Host, text), flaw_of_host, context))
    return hosts[-1] if hosts else Host()


def _with_acknowledged(transmission: Transmission) -> Transmission:
    """An acknowledgement that refers to what it acknowledges; in files of the first builds, only its name does."""
    if transmission.purpose is not Purpose.ACKNOWLEDGEMENT or transmission.acknowledges is not None:
        return transmission
    acknowledged = transmission.name.removesuffix("_acknowledgement")
    return transmission if acknowledged == transmission.name else replace(transmission, acknowledges=acknowledged)


def _extracted(
    elements: Iterable[Any],
    key: str,
    read: Callable[[Element, str], T],
    flaw_of: Callable[[T], str | None],
    context: Extracting,
) -> Iterator[T]:
    for element in elements:
        for item in element.custom_properties:
            if item.key == key:
                try:
                    found = read(element, _text(item))
                    if (flaw := flaw_of(found)) is not None:
                        raise UnknownError(flaw)
                except UnknownError as error:
                    context.note("EXT005", f"the property {key!r} cannot be read: {error}", element)
                    context.without_property.add(element)
                else:
                    yield found


def _text(item: am.CustomProperty) -> str:
    if not isinstance(item.value, am.StringObject):
        raise UnknownError("it is not a text")
    return item.value.value or ""


def without_unreadable(system: System, tasks: Iterable[am.Task], models: Iterable[am.SWModel], context: Extracting) -> System:
    """The system, in which nothing is known of tasks with properties that cannot be read; of all of them if that is one of a model."""
    is_network_lost = any(model in context.without_property for model in models)
    unknown = {context.names[task] for task in tasks if is_network_lost or task in context.without_property}
    return with_unknown_activation(system, unknown) if unknown else system
