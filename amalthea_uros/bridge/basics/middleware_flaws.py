"""What files say of executors, wires and the host beside their own classes: what of it cannot be used, and what is unknown then."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace
from typing import Any

from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.host import Host, HostExecutor, HostPolicy, HostTopic
from amalthea_uros.perf.network import BILLION, MOST_LOST, Losses, Network, Purpose, Recovery, Transmission
from amalthea_uros.perf.stimuli import Custom
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time


def flaw_of_executor(executor: Executor, system: System) -> str | None:
    """Why an executor of a file does not belong to a system; None if it does."""
    called = (handle.runnable for handle in executor.handles)
    takes = (handle.take for handle in executor.handles if handle.take is not None)
    busy = () if executor.busy_wait is None else (executor.busy_wait,)
    if not all(0 <= each.sleep_early <= each.sleep for each in (executor.loop, executor.place or executor.loop)):
        return "a sleep can be shorter by more than its time"
    for handle in executor.handles:
        if not _is_above_zero(handle.interval) or handle.jitter < 0:
            return f"the interval or jitter of {handle.name!r} is not valid"
    return _missing("runnable", (executor.spin, *called, *takes, *busy), system.runnables)


def flaw_of_network(network: Network, system: System) -> str | None:
    """Why the network of a file does not belong to a system, or has losses that no description can state; None if it does."""
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
    is_counted = 1 <= losses.count <= MOST_LOST and losses.window > 0 and not losses.per_billion
    is_share = not losses.count and not losses.window and 0 < losses.per_billion < BILLION
    if not losses.directions or len(set(losses.directions)) < len(losses.directions):
        return "losses need one direction or both"
    return None if is_counted or is_share else "losses are neither a number in a time nor a probability"


def _flaw_of_recovery(recovery: Recovery) -> str | None:
    """A side that asks again after no time would never do anything else."""
    if recovery.asks_after <= 0 or recovery.agent_asks_every <= 0:
        return "the times until missing acknowledgements are asked for are not above zero"
    parts = recovery.sent_parts, recovery.received_parts, recovery.agent_sent_parts
    return "a number of parts is not above zero" if any(each is not None and each < 1 for each in parts) else None


def flaw_of_transmission(transmission: Transmission, network: Network, system: System) -> str | None:
    """Why a transmission of a file does not belong to a system; None if it does."""
    wires = {wire.name for wire in network.wires}
    return _missing("wire", [transmission.wire], wires) or _missing("process", transmission.processes, system.processes)


def has_old_topic(transmission: Transmission) -> bool:
    """Whether a message of a service has the name of that as its topic, as in models of older builds; its own name shows what it is."""
    topic, name = transmission.topic, transmission.name
    if not topic or transmission.purpose is not Purpose.DATA or f"{topic}_topic_" in name:
        return False
    return any(f"{topic}_{kind}_" in name and not topic.endswith(f"/{kind}") for kind in ("request", "response"))


def _is_above_zero(time: Time | None) -> bool:
    return time is None or time > 0


def _missing(kind: str, names: Iterable[str], known: Any) -> str | None:
    return next((f"undefined {kind} {name!r}" for name in names if name not in known), None)


def flaw_of_host(host: Host) -> str | None:
    """What no description of a host can state, and would make bounds too low or an analysis fail; None if there is nothing."""
    computers = {computer.name for computer in host.computers}
    names = [callback.name for callback in host.callbacks]
    if len(set(names)) < len(names):
        return "two callbacks of the host have one name"
    if any(computer.cores < 1 for computer in host.computers):
        return "a computer has no core"
    flaws = [
        _missing("computer", (executor.computer for executor in host.executors), computers),
        *map(_flaw_of_host_executor, host.executors),
        *map(_flaw_of_host_topic, host.topics),
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
        is_kind_clear = (callback.period is None) is not (callback.topic is None)
        if spans or not is_kind_clear or not _is_above_zero(callback.period) or callback.depth < 1:
            return f"the callback {callback.name!r} is not valid"
    return None


def _flaw_of_host_topic(topic: HostTopic) -> str | None:
    is_valid = _is_above_zero(topic.interval) and topic.jitter >= 0 and topic.latency.least >= 0
    return None if is_valid else f"the topic {topic.name!r} is not valid"


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
