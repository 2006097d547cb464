"""Executors, the network and the host, as custom properties: AMALTHEA has no classes for them.

An executor is a property of the task that executes its rounds, a transmission of the task that stands for it, and the wires and the
host are properties of the software model. Other tools ignore them.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any, TypeVar

from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.json_text import from_text, to_text
from amalthea_uros.bridge.basics.kinds import ObjectKind
from amalthea_uros.errors import UnknownError
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.host import Host, HostExecutor, HostPolicy
from amalthea_uros.perf.network import BILLION, MOST_LOST, Losses, Network, Purpose, Recovery, Transmission
from amalthea_uros.perf.stimuli import Custom
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
        _extracted(tasks, _EXECUTOR, partial(_executor, context), lambda found: _flaw_of_executor(found, system), context)
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
            lambda network: _flaw_of_network(network, system),
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
        lambda task, text: from_text(Transmission, text, name=context.names[task], origin=partial(context.location, task)),
        lambda each: _flaw_of_transmission(each, network, system),
        context,
    )
    return replace(network, transmissions=tuple(map(_with_acknowledged, transmissions)))


def extract_host(models: Iterable[am.SWModel], context: Extracting) -> Host:
    """The host; the one of the last file that has one."""
    hosts = list(_extracted(models, _HOST, lambda _, text: from_text(Host, text), _flaw_of_host, context))
    return hosts[-1] if hosts else Host()


def _flaw_of_host(host: Host) -> str | None:
    """What no description can state, and would make bounds too low or an analysis fail."""
    computers = {computer.name for computer in host.computers}
    names = [callback.name for callback in host.callbacks]
    if len(set(names)) < len(names):
        return "two callbacks of the host have one name"
    if any(computer.cores < 1 for computer in host.computers):
        return "a computer has no core"
    flaws = [
        _missing("computer", (executor.computer for executor in host.executors), computers),
        *map(_flaw_of_host_executor, host.executors),
    ]
    return next(filter(None, flaws), None)


def _flaw_of_host_executor(executor: HostExecutor) -> str | None:
    thread = executor.thread
    if thread.policy is HostPolicy.DEADLINE and not 0 < thread.budget <= thread.period:
        return f"the budget of {executor.name!r} is not within its period"
    if executor.threads < 1:
        return f"{executor.name!r} has no thread"
    for callback in executor.callbacks:
        spans = callback.execution.least < 0 or (callback.execution.most or 1) < max(1, callback.execution.least)
        if spans or (callback.period is None) is (callback.topic is None) or (callback.period or 1) < 1 or callback.depth < 1:
            return f"the callback {callback.name!r} is not valid"
    return None


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


def _flaw_of_executor(executor: Executor, system: System) -> str | None:
    called = (handle.runnable for handle in executor.handles)
    takes = (handle.take for handle in executor.handles if handle.take is not None)
    busy = () if executor.busy_wait is None else (executor.busy_wait,)
    return _missing("runnable", (executor.spin, *called, *takes, *busy), system.runnables)


def _flaw_of_network(network: Network, system: System) -> str | None:
    cores = (core for wire in network.wires for core in wire.cores)
    flaws = [
        _missing("core", cores, system.cores),
        _missing("runnable", (each.runnable for each in network.waits), system.runnables),
        *(_flaw_of_losses(losses) for wire in network.wires for losses in wire.losses),
        *(_flaw_of_recovery(wire.recovery) for wire in network.wires if wire.recovery is not None),
    ]
    return next(filter(None, flaws), None)


def _flaw_of_losses(losses: Losses) -> str | None:
    """What no description can state: it would lose less than it says, or make a simulation fail."""
    is_counted = 1 <= losses.count <= MOST_LOST and 0 < losses.window < 2**63 and not losses.per_billion
    is_share = not losses.count and not losses.window and 0 < losses.per_billion < BILLION
    if not losses.directions or len(set(losses.directions)) < len(losses.directions):
        return "losses need one direction or both"
    return None if is_counted or is_share else "losses are neither a number in a time nor a probability"


def _flaw_of_recovery(recovery: Recovery) -> str | None:
    """A side that asks again after no time would never do anything else."""
    if not (0 < recovery.asks_after < 2**63 and 0 < recovery.agent_asks_every < 2**63):
        return "the times until missing acknowledgements are asked for are not above zero"
    parts = recovery.sent_parts, recovery.received_parts, recovery.agent_sent_parts
    return "a number of parts is not above zero" if any(each is not None and each < 1 for each in parts) else None


def _flaw_of_transmission(transmission: Transmission, network: Network, system: System) -> str | None:
    wires = {wire.name for wire in network.wires}
    return _missing("wire", [transmission.wire], wires) or _missing("process", transmission.processes, system.processes)


def _missing(kind: str, names: Iterable[str], known: Any) -> str | None:
    return next((f"undefined {kind} {name!r}" for name in names if name not in known), None)


def with_unknown_activation(system: System, names: Collection[str]) -> System:
    """The system, in which it is not known what activates some tasks: what they mean was said in a property that cannot be read."""
    unknown = Custom(name="unknown executor or transmission", description="a property of its task cannot be read")
    tasks = [
        replace(task, stimuli=(*task.stimuli, unknown.name)) if task.name in names else task for task in system.software.tasks
    ]
    return replace(
        system,
        stimuli=replace(system.stimuli, stimuli=(*system.stimuli.stimuli, unknown)),
        software=replace(system.software, tasks=tuple(tasks)),
    )
