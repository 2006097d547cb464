"""The steps of an iteration, as a simulation takes them: what the task of an executor does, with each decision at a place of its own.

In a model, the task of an executor calls by chance what may be ready, because nobody knows it before. Whoever follows the messages
knows it: then each handle has one or two steps, in the order of the executor, which are taken or not.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.executors.semantics.readiness import messages, shares_session
from amalthea_uros.perf.activities import (
    Activity,
    Call,
    Chance,
    Communication,
    LabelAccess,
    ProbabilitySwitch,
    Trigger,
    called_runnables,
    transformed,
)
from amalthea_uros.perf.executors import Executor, Handle
from amalthea_uros.perf.network import Direction, Purpose, Transmission
from amalthea_uros.perf.os import Semaphore, SemaphoreKind
from amalthea_uros.perf.software import Runnable, Task
from amalthea_uros.perf.stimuli import InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.relays import relayed


@dataclass(frozen=True, slots=True)
class IterationStep:
    """A part of an iteration that is executed if a handle is ready.

    Attributes
    ----------
    takes : whether it takes the message of the handle, or sets the timer to its next expiration
    calls : whether it calls the callback
    """

    handle: Handle
    takes: bool
    calls: bool

    @property
    def activities(self) -> tuple[Activity, ...]:
        """Taking the message, and the callback."""
        take = self.handle.take if self.takes else None
        return tuple(Call(runnable=name) for name in (take, self.handle.runnable if self.calls else None) if name is not None)


def steps_of(executor: Executor) -> tuple[IterationStep, ...]:
    """The steps of an iteration after the wait, in order: see ros2/rclc `executor.c`."""
    return tuple(_steps(executor))


def _steps(executor: Executor) -> Iterator[IterationStep]:
    # Only messages are taken before: a timer is set to its next time when its callback is called.
    before = messages(executor) if executor.takes_first else ()
    yield from (IterationStep(handle, takes=True, calls=False) for handle in before)
    for handle in executor.handles:
        # What is always called takes a message only if there is one.
        if handle.always and handle not in before:
            yield IterationStep(handle, takes=True, calls=False)
        yield IterationStep(handle, takes=handle not in before and not handle.always, calls=True)


def iterations_name(executor: str) -> str:
    """The name of the stimulus that activates an iteration of an executor."""
    return f"iterations_of_{executor}"


def session_lock(executor: Executor) -> str:
    """The name of the lock of a session that several executors share."""
    return f"lock of {executor.session}"


def with_steps(system: System) -> System:
    """The system with the steps of the iterations of its executors, and with everything that sends a message triggering it.

    Each step is a switch of two branches of which the second one is empty.
    """
    if not system.executors and not system.network.transmissions:
        return system
    own = system.executor_of_task
    tasks = [_with_steps(task, own[task.name]) if task.name in own else task for task in system.software.tasks]
    # The operating system activates the task of an executor for each iteration, too.
    begins = {name: iterations_name(each.name) for each in system.executors for name in system.processes[each.task].stimuli}
    isrs = [
        replace(isr, stimuli=tuple(dict.fromkeys(begins.get(name, name) for name in isr.stimuli)))
        for isr in system.software.isrs
    ]
    within = _within_callbacks(system)
    runnables = [
        _publishing(_accessing_at_once(each) if each.name in within else each, system) for each in system.software.runnables
    ]
    started = [InterProcess(name=iterations_name(executor.name), origin=executor.origin) for executor in system.executors]
    sent = {name for each in _sent(system) for name in system.processes[each.name].stimuli}
    stimuli = [
        InterProcess(name=each.name, origin=each.origin) if each.name in sent else each for each in system.stimuli.stimuli
    ]
    shared = dict.fromkeys(session_lock(each) for each in system.executors if shares_session(each, system.executors))
    locks = [Semaphore(name=name, kind=SemaphoreKind.MUTEX) for name in shared]
    return replace(
        system,
        os=replace(system.os, semaphores=(*system.os.semaphores, *locks)),
        stimuli=replace(system.stimuli, stimuli=(*stimuli, *started)),
        software=replace(system.software, tasks=tuple(tasks), isrs=tuple(isrs), runnables=tuple(runnables)),
    )


def _with_steps(task: Task, executor: Executor) -> Task:
    # Whoever follows iterations executes those of which polling is the sum.
    own = {executor.poll, *(name for handle in executor.handles for name in (handle.take, handle.runnable))}
    # Other activities are overhead of the operating system, around the iteration.
    others = [each for each in task.activities if own.isdisjoint(called_runnables((each,)))]
    first = next((n + 1 for n, each in enumerate(others) if isinstance(each, Call) and each.runnable == executor.spin), 0)
    switches = [_switch(step) for step in steps_of(executor)]
    return replace(
        task,
        stimuli=(iterations_name(executor.name),),
        activities=(*others[:first], *switches, *others[first:]),
    )


def _switch(step: IterationStep) -> ProbabilitySwitch:
    return ProbabilitySwitch(branches=(Chance(weight=1.0, activities=step.activities), Chance(weight=1.0, activities=())))


def _within_callbacks(system: System) -> set[str]:
    """The runnables that only callbacks of executors call, and those that these call."""
    handles = [handle for executor in system.executors for handle in executor.handles]
    others = [each for name, each in system.processes.items() if name not in system.executor_of_task]
    roots = (name for handle in handles for name in (handle.take, handle.runnable) if name is not None)
    return _reached(roots, system) - _reached((name for each in others for name in called_runnables(each.activities)), system)


def _reached(roots: Iterable[str], system: System) -> set[str]:
    """Some runnables, and those that they call, directly or not."""
    reached: set[str] = set()
    new = set(roots)
    while new:
        called = [system.runnables[name] for name in new if name in system.runnables]
        reached |= {each.name for each in called}
        new = {name for each in called for name in called_runnables(each.activities)} - reached
    return reached


def _accessing_at_once(runnable: Runnable) -> Runnable:
    """A callback whose accesses to labels take effect where they are, unless they are modelled otherwise.

    An iteration waits at its beginning for what it is about, so that copies made there would be older than everything.
    """
    return replace(runnable, activities=transformed(runnable.activities, _at_once))


def _at_once(activity: Activity) -> Activity:
    if isinstance(activity, LabelAccess) and activity.communication is None:
        return replace(activity, communication=Communication.EXPLICIT)
    return activity


def _publishing(runnable: Runnable, system: System) -> Runnable:
    """A callback with a trigger for each message that it publishes; some have none, as their rate alone is known."""
    handles = (handle for executor in system.executors for handle in executor.handles if handle.runnable == runnable.name)
    handle = next(handles, None)
    if handle is None:
        return runnable
    triggered = {each.stimulus for each in runnable.activities if isinstance(each, Trigger)}
    names = (each.transmission for each in handle.publications if each.transmission in system.transmissions)
    stimuli = [stimulus for name in names if name is not None for stimulus in system.processes[name].stimuli[:1]]
    missing = [Trigger(stimulus=each) for each in dict.fromkeys(stimuli) if each not in triggered]
    return replace(runnable, activities=(*runnable.activities, *missing))


def _sent(system: System) -> Iterator[Transmission]:
    """Messages that are sent here: publications of callbacks, acknowledgements, what asks for them, and what the agent sends back."""
    asking = {wire.name for wire in system.network.wires if wire.recovery is not None}
    published = {
        each.transmission for executor in system.executors for handle in executor.handles for each in handle.publications
    }
    for each in system.transmissions.values():
        # Only an executor that loops acknowledges what it reads when it reads it.
        loops = bool(system.client_at(each.wire).executors)
        is_asking = each.purpose is Purpose.HEARTBEAT and loops and each.wire in asking
        is_reply = each.purpose is Purpose.ACKNOWLEDGEMENT and (loops or each.direction is Direction.TO_CONTROLLER)
        if is_reply or is_asking or each.name in published or relayed(each, system):
            yield each
