"""The host as part of the simulated system: a task for each thread of an executor, a core for each of a computer.

Whether the host can be simulated is decided for all of it, because its executors activate each other by messages.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from amalthea_uros.perf.activities import Call, Demand, Execute
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.events import CustomEvent, Event, RunnableChange, RunnableEvent
from amalthea_uros.perf.hardware import Clock, Core, Structure, StructureKind
from amalthea_uros.perf.host import Host, HostCallback, HostComputer, HostExecutor, HostExecutorKind, HostPolicy
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.network import Direction, Purpose, Transmission, plain_topic
from amalthea_uros.perf.os import OperatingSystem, Parameter, Parent, Policy, Scheduler
from amalthea_uros.perf.software import Runnable, Task
from amalthea_uros.perf.stimuli import InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.units import Duration

#: With what the names begin that stand for the host; other names cannot contain it.
_PREFIX = "host/"
#: A tick is a picosecond, so that execution times of the host are exact.
_FREQUENCY = Fraction(10**12)
_CLOCK = f"{_PREFIX}clock"
#: The priorities of SCHED_FIFO are up to 99.
_ABOVE_PRIORITIES = 100


def with_host(system: System) -> System:
    """The system with the threads of its host as tasks, if it can be simulated."""
    host = system.host
    if not host.executors or why_not_simulated(system):
        return system
    software, mapping, hardware = system.software, system.mapping, system.hardware
    threads = [(executor, name) for executor in host.executors for name in thread_names(executor)]
    return replace(
        system,
        hardware=replace(
            hardware,
            clocks=(*hardware.clocks, Clock(name=_CLOCK, frequency=_FREQUENCY)),
            structures=(*hardware.structures, *map(_structure, host.computers)),
        ),
        os=replace(
            system.os, systems=(*system.os.systems, *(_operating_system(computer, host) for computer in host.computers))
        ),
        stimuli=replace(system.stimuli, stimuli=(*system.stimuli.stimuli, *(InterProcess(name=name) for _, name in threads))),
        software=replace(
            software,
            tasks=(*software.tasks, *(_task(executor, name) for executor, name in threads)),
            runnables=(*software.runnables, *map(_runnable, host.callbacks)),
        ),
        mapping=replace(mapping, tasks=(*mapping.tasks, *(_allocation(executor, name) for executor, name in threads))),
        events=replace(system.events, events=tuple(_located(event, host) for event in system.events.events)),
    )


def _located(event: Event, host: Host) -> Event:
    """An event that stands for a callback of the host as one of its runnable, in whichever thread calls it."""
    if not isinstance(event, CustomEvent):
        return event
    changes = {"start": RunnableChange.START, "finish": RunnableChange.TERMINATE}
    for callback in host.callbacks:
        for moment, change in changes.items():
            if event.name == f"{callback.name}_{moment}":
                return RunnableEvent(name=event.name, runnable=runnable_name(callback), change=change, origin=event.origin)
    return event


def host_name(executor: HostExecutor) -> str:
    """The name of an executor among those of controllers."""
    return f"{_PREFIX}{executor.name}"


def thread_names(executor: HostExecutor) -> tuple[str, ...]:
    """The names of the tasks that stand for the threads of an executor; it has none if it calls nothing."""
    if not executor.callbacks:
        return ()
    if executor.kind is not HostExecutorKind.MULTI_THREADED:
        return (host_name(executor),)
    return tuple(f"{host_name(executor)}/{number + 1}" for number in range(executor.threads))


def runnable_name(callback: HostCallback) -> str:
    """The name of the runnable that stands for a callback."""
    return f"{_PREFIX}{callback.name}"


def sent_to_host(system: System, topic: str) -> list[Transmission]:
    """The messages of a topic that the agent publishes on the host."""
    return [each for each in _data(system, Direction.TO_AGENT) if plain_topic(each.topic) == topic]


def sent_by_host(system: System, topic: str) -> list[Transmission]:
    """The messages of a topic that the host sends to a controller."""
    return [each for each in _data(system, Direction.TO_CONTROLLER) if plain_topic(each.topic) == topic]


def depending(system: System, left_out: Mapping[str, str]) -> dict[str, str]:
    """The threads of the host that are not simulated either, because they would get too few messages, and why."""
    host = system.host
    threads = [name for executor in host.executors for name in thread_names(executor) if name in system.processes]
    topics = {topic for callback in host.callbacks for topic in (*callback.publishes, callback.topic or "")}
    is_shared = any(sent_to_host(system, topic) or sent_by_host(system, topic) for topic in topics)
    origins = [name for name in left_out if name in threads or is_shared]
    reasons = dict.fromkeys(threads, f"depends on {origins[0]!r}, which is not simulated") if origins else {}
    return reasons | {name: reason for name, reason in left_out.items() if name in reasons}


def _data(system: System, direction: Direction) -> Iterator[Transmission]:
    every = system.transmissions.values()
    return (each for each in every if each.direction is direction and each.purpose is Purpose.DATA)


def why_not_simulated(system: System) -> str:
    """Why the host of a system is not simulated; "" if it is."""
    return next(_obstacles(system), "")


def _obstacles(system: System) -> Iterator[str]:
    host = system.host
    topics = {topic.name: topic for topic in host.topics}
    published = {topic for callback in host.callbacks for topic in callback.publishes}
    for executor in host.executors:
        if host.is_fairly_shared(executor):
            yield f"the thread of {executor.name!r} has the policy 'other', so that it is unknown what delays it"
        if _is_reserved(executor) and len(_allowed(executor, host)) > 1:
            yield f"the reservation of {executor.name!r} has several cores; set 'core' of its 'thread'"
        if _is_reserved(executor) and executor.kind is HostExecutorKind.MULTI_THREADED:
            yield f"the reservations of the multi-threaded executor {executor.name!r} are not simulated"
        for callback in executor.callbacks:
            if callback.execution.most is None:
                yield f"the execution time of {callback.name!r} has no maximum"
            if callback.reads or callback.writes:
                yield f"{callback.name!r} reads or writes variables, which is not simulated"
            topic = callback.topic
            if topic is None:
                continue
            is_described = topic in published or bool(sent_to_host(system, topic))
            if not is_described and (topic not in topics or not topics[topic].interval):
                yield f"neither a callback of the host nor a controller with a 'transport' publishes {topic!r}"
            if is_described and topics[topic].latency.most is None:
                yield f"the latency of the topic {topic!r} is not specified"
        yield from _obstacles_to_controllers(executor, host, system)


def _obstacles_to_controllers(executor: HostExecutor, host: Host, system: System) -> Iterator[str]:
    """Why it is unknown when messages of an executor get to a controller, or those of a controller to it."""
    latencies = {topic.name: topic.latency.most for topic in host.topics}
    for callback in executor.callbacks:
        for topic in callback.publishes:
            for each in sent_by_host(system, topic):
                if latencies.get(topic) is None or each.agent.simulated.most is None:
                    yield f"it is not specified how long messages of {topic!r} take to the controller"
                if not any(handle.transmission == each.name for one in system.executors for handle in one.handles):
                    yield f"the callback {each.callback!r} of the controller receives {topic!r} outside of executors with loops"
        for each in sent_to_host(system, callback.topic or ""):
            if each.agent.simulated.most is None:
                yield f"it is not specified how long messages of {callback.topic!r} take to the host"


def _structure(computer: HostComputer) -> Structure:
    cores = tuple(Core(name=name, clock=_CLOCK) for name in _cores(computer.name, range(computer.cores)))
    return Structure(name=f"{_PREFIX}{computer.name}", kind=StructureKind.ECU, cores=cores)


def host_cores(executor: HostExecutor, host: Host) -> tuple[str, ...]:
    """The names of the cores on which the threads of an executor may run."""
    return _cores(executor.computer, _allowed(executor, host))


def _allowed(executor: HostExecutor, host: Host) -> tuple[int, ...]:
    """The cores on which the threads of an executor may run."""
    return executor.thread.cores or tuple(range(host.computer_of(executor).cores))


def _cores(computer: str, numbers: range | tuple[int, ...]) -> tuple[str, ...]:
    return tuple(f"{_PREFIX}{computer}/core {number}" for number in numbers)


def _operating_system(computer: HostComputer, host: Host) -> OperatingSystem:
    """The scheduler of a computer: by priority, and above all priorities the reservations by their deadlines."""
    cores, name = _cores(computer.name, range(computer.cores)), f"{_PREFIX}{computer.name}"
    scheduler = Scheduler(name=name, policy=Policy.FIXED_PRIORITY_PREEMPTIVE, cores=cores, executing_core=cores[0])
    above = Parent(scheduler=name, priority=_ABOVE_PRIORITIES)
    by_deadline = Scheduler(name=_by_deadline(computer.name), policy=Policy.EARLIEST_DEADLINE_FIRST, parent=above)
    reserved = [each for each in host.executors if each.computer == computer.name and _is_reserved(each)]
    servers = (_server(executor, host) for executor in reserved if executor.callbacks)
    return OperatingSystem(name=name, schedulers=(scheduler, by_deadline, *servers))


def _by_deadline(computer: str) -> str:
    return f"{_PREFIX}{computer}/deadlines"


def _server(executor: HostExecutor, host: Host) -> Scheduler:
    budget, period = (
        Parameter(name=name, values=(Duration(time),))
        for name, time in (("capacity", executor.thread.budget), ("period", executor.thread.period))
    )
    return Scheduler(
        name=host_name(executor),
        policy=Policy.CONSTANT_BANDWIDTH_SERVER,
        cores=host_cores(executor, host),
        parent=Parent(scheduler=_by_deadline(executor.computer), deadline=executor.thread.period, parameters=(budget, period)),
    )


def _is_reserved(executor: HostExecutor) -> bool:
    return executor.thread.policy is HostPolicy.DEADLINE


def _allocation(executor: HostExecutor, thread: str) -> TaskAllocation:
    is_reserved = _is_reserved(executor)
    return TaskAllocation(
        task=thread,
        scheduler=host_name(executor) if is_reserved else f"{_PREFIX}{executor.computer}",
        priority=None if is_reserved else executor.thread.priority,
        cores=_cores(executor.computer, executor.thread.cores),
        origin=executor.origin,
    )


def _task(executor: HostExecutor, thread: str) -> Task:
    """A thread; what it calls in a job is decided by the kernel."""
    calls = tuple(Call(runnable=runnable_name(callback)) for callback in executor.callbacks)
    # Each job begins the next one.
    return Task(name=thread, stimuli=(thread,), activities=calls, activation_limit=2, origin=executor.origin)


def _runnable(callback: HostCallback) -> Runnable:
    most = callback.execution.most or 0
    demand = Demand(ticks=Boundaries(lower=callback.execution.least, upper=most))
    return Runnable(name=runnable_name(callback), activities=(Execute(demand=demand),), origin=callback.origin)
