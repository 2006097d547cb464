"""What each received message passes in the controller before an executor sees it: the interrupt, and tasks of the middleware.

The interrupt is triggered by each frame on the wire, each task of the middleware by the process before it, and the last one triggers
the rounds of executors that wait. Only the last frame of a message ends a wait; the interrupt for other frames and for acknowledgements
and heartbeats is a process of its own in the model, as it triggers nothing. If nothing is described, nothing is passed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.perf.activities import Activity, Call, Demand, Execute, Trigger
from amalthea_uros.perf.network import Direction
from amalthea_uros.perf.software import UNLIMITED, Runnable
from amalthea_uros.perf.stimuli import InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.spec.middleware import MiddlewareTask
from amalthea_uros.spec.transports import Interrupt
from amalthea_uros.uros.assembly.context import AssemblyContext, add_isr
from amalthea_uros.uros.assembly.executor_runnables import message_cost
from amalthea_uros.uros.assembly.planned import PlannedTask, activity_sequence, trigger_name
from amalthea_uros.uros.middleware.profile import MiddlewareThread
from amalthea_uros.uros.transports.line import receive_interrupt
from amalthea_uros.uros.transports.messages import WireMessage


@dataclass(frozen=True, slots=True, kw_only=True)
class Receivers:
    """The processes that receive.

    Attributes
    ----------
    processes : that each message passes, in order
    message_triggers : stimuli that the last frame of a message triggers
    other_triggers : stimuli that other frames trigger
    """

    processes: tuple[str, ...] = ()
    message_triggers: tuple[str, ...] = ()
    other_triggers: tuple[str, ...] = ()


def add_receivers(context: AssemblyContext, messages: Sequence[WireMessage], wakes: Sequence[str]) -> Receivers:
    """Add the processes that receive messages, and return what triggers them.

    Parameters
    ----------
    wakes : the stimuli of the rounds of executors that wait for messages
    """
    middleware = context.description.middleware
    interrupt = receive_interrupt(middleware.transport)
    incoming = [message for message in messages if message.direction is Direction.TO_CONTROLLER]
    threads = [thread for thread in context.profile.threads if thread.period is None] if incoming else []
    triggers = wakes
    for thread in reversed(threads):
        triggers = (_add_thread(context, thread, incoming, triggers),)
    names = tuple(thread.name for thread in threads)
    if interrupt is None:
        return Receivers(processes=names, message_triggers=tuple(triggers))
    others = (_add_isr(context, interrupt, name_for_other_frames(interrupt), ()),)
    if not incoming:
        return Receivers(other_triggers=others)
    last = (_add_isr(context, interrupt, interrupt.name, triggers),)
    return Receivers(processes=(interrupt.name, *names), message_triggers=last, other_triggers=others)


def name_for_other_frames(interrupt: Interrupt) -> str:
    """The name of the interrupt service routine when it receives a frame without the end of a message of the application."""
    return f"{interrupt.name}_Other"


def without_idle(system: System, stimuli: Sequence[str]) -> System:
    """A system without the interrupt service routines of stimuli that nothing triggers.

    Messages of one frame that are not acknowledged leave the interrupt for other frames without any.
    """
    triggered = {
        activity.stimulus for task in system.software.tasks for activity in task.activities if isinstance(activity, Trigger)
    }
    idle = {stimulus for stimulus in stimuli if stimulus not in triggered}
    isrs = tuple(isr for isr in system.software.isrs if not idle.intersection(isr.stimuli))
    if len(isrs) == len(system.software.isrs):
        return system
    removed = {isr.name for isr in system.software.isrs} - {isr.name for isr in isrs}
    return replace(
        system,
        stimuli=replace(system.stimuli, stimuli=tuple(each for each in system.stimuli.stimuli if each.name not in idle)),
        software=replace(system.software, isrs=isrs),
        mapping=replace(system.mapping, isrs=tuple(each for each in system.mapping.isrs if each.isr not in removed)),
    )


def _add_isr(context: AssemblyContext, interrupt: Interrupt, name: str, triggers: Sequence[str]) -> str:
    """Add an interrupt service routine, and return its stimulus."""
    stimulus = context.stimuli.add(InterProcess(name=trigger_name(name), origin=interrupt.location()))
    add_isr(context, interrupt, name, [stimulus], triggers)
    return stimulus


def _add_thread(
    context: AssemblyContext, thread: MiddlewareThread, messages: Sequence[WireMessage], triggers: Sequence[str]
) -> str:
    """Add a task of the middleware that handles each received message, and return its stimulus."""
    middleware = context.description.middleware
    section = next((task for task in middleware.tasks if task.name == thread.name), None)
    core = context.core(section.core if section else None, section.location("core") if section else None)
    stated = section.priority if section else None
    priority = thread.priority if stated is None else stated
    origin = section.location() if section else middleware.location()
    body = Runnable(name=f"{thread.name}_Message", activities=_cost(context, section, thread, messages, core), origin=origin)
    context.runnables[body.name] = body
    context.tasks.append(
        PlannedTask(
            name=thread.name,
            core=core,
            stimuli=(context.stimuli.add(InterProcess(name=trigger_name(thread.name), origin=origin)),),
            activities=(Call(runnable=body.name), *_triggers(triggers)),
            period=min(message.interval - message.jitter for message in messages),
            priority=middleware.stated_executors[0].priority if priority is None else priority,
            activation_limit=UNLIMITED,  # no message is lost between the wire and the task
            origin=origin,
        )
    )
    return trigger_name(thread.name)


def _cost(
    context: AssemblyContext,
    section: MiddlewareTask | None,
    thread: MiddlewareThread,
    messages: Sequence[WireMessage],
    core: str,
) -> tuple[Activity, ...]:
    """What a message costs in a task; unknown if it is not stated."""
    cost = section.execution_time if section else None
    if section is None or cost is None:
        text = f"the execution time of {thread.name!r} per message is not specified, so that its response time is unknown"
        advice = f"Set 'execution_time' of {thread.name!r} under 'tasks' of 'middleware'."
        context.notes.warning("UR136", text, section.location() if section else context.description.location(), advice)
        return (Execute(demand=Demand()),)
    largest = max(message.message.size for message in messages)
    return activity_sequence(context.converter.execute(message_cost(cost, largest), core, section.location("execution_time")))


def _triggers(stimuli: Sequence[str]) -> Iterator[Trigger]:
    return (Trigger(stimulus=stimulus) for stimulus in stimuli)
