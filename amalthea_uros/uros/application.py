"""The application: its callbacks in their own tasks or in the executor, and the interrupt that receives their messages."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.software import Runnable
from amalthea_uros.spec.transports import Interrupt
from amalthea_uros.units import Time
from amalthea_uros.uros.activities import activity_sequence
from amalthea_uros.uros.bus_messages import BusMessage, bus_of, receive_stimulus
from amalthea_uros.uros.callbacks import Callback, registration_order
from amalthea_uros.uros.context import AssemblyContext
from amalthea_uros.uros.executor import (
    ExecutorRunnables,
    PlannedCall,
    in_executor_calls,
    message_cost,
    own_task_calls,
    timer_count,
)
from amalthea_uros.uros.periods import (
    PeriodChoice,
    check_callbacks_in_executor,
    choose_executor_period,
    choose_task_period,
    period_candidates,
)
from amalthea_uros.uros.phases import ExecutorPhases, own_task_counter
from amalthea_uros.uros.tasks import PlannedIsr, PlannedTask


def add_callbacks(context: AssemblyContext, callbacks: Sequence[Callback]) -> tuple[PeriodChoice, ...]:
    """Add the executor and the callbacks' own tasks, and return the choice of their periods, that of the executor first."""
    middleware, converter, notes = context.description.middleware, context.converter, context.notes
    executor, candidates = middleware.executor, period_candidates(middleware)
    outside = [callback for callback in callbacks if not callback.in_executor]
    inside = registration_order((callback for callback in callbacks if callback.in_executor), executor, notes)
    choices = [
        choice for callback in outside if (choice := choose_task_period(callback, candidates, converter, notes)) is not None
    ]
    check_callbacks_in_executor(inside, converter, notes)
    if not choices and not inside:
        return ()
    chosen = choose_executor_period(executor, candidates, choices, inside, notes)
    if chosen is None:
        return ()
    core = context.core(executor.core, executor.location("core"))
    bodies = {callback.name: _body(context, callback, core) for callback in callbacks}
    _add_executor(context, _executor_calls(context, outside, inside, bodies, chosen.period, core), chosen.period, core)
    periods = {choice.task: choice.period for choice in choices}
    for callback in outside:
        if callback.name in periods:
            _add_own_task(context, callback, periods[callback.name], bodies[callback.name])
    _check_phases(context, callbacks, chosen.period)
    return (chosen, *choices)


def _check_phases(context: AssemblyContext, callbacks: Sequence[Callback], period: Time) -> None:
    calls = [call for task in context.tasks for call in task.activities if isinstance(call, Call)]
    counted = {call.counter.source for call in calls if call.counter is not None}
    phases = ExecutorPhases.of(context.description.middleware.executor, period, callbacks)
    for callback in callbacks:
        phases.check(callback, callback.name in counted, context.notes)


def _executor_calls(
    context: AssemblyContext,
    outside: Sequence[Callback],
    inside: Sequence[Callback],
    bodies: dict[str, Runnable],
    period: Time,
    core: str,
) -> list[PlannedCall]:
    runnables = ExecutorRunnables(
        middleware=context.description.middleware, converter=context.converter, core=core, channels=context.channels
    )
    phases = ExecutorPhases.of(context.description.middleware.executor, period, (*outside, *inside))
    return [
        PlannedCall(runnable=runnables.spin(timer_count((*outside, *inside)))),
        *own_task_calls(outside, runnables, phases),
        *in_executor_calls(inside, bodies, runnables, phases),
    ]


def _add_executor(context: AssemblyContext, calls: Sequence[PlannedCall], period: Time, core: str) -> None:
    executor = context.description.middleware.executor
    context.runnables |= {call.runnable.name: call.runnable for call in calls}
    context.tasks.append(
        PlannedTask(
            name=executor.name,
            core=core,
            stimuli=(context.stimuli.periodic(period, executor.offset, executor.location()),),
            activities=tuple(call.call for call in calls),
            period=period,
            priority=executor.priority,
            deadline=executor.deadline,
            overhead=executor.overhead,
            wins_ties=True,
            origin=executor.location(),
        )
    )


def _core(context: AssemblyContext, callback: Callback, executor_core: str) -> str:
    """The core of a callback."""
    section, node = callback.section, callback.node
    if callback.in_executor:
        if section.overhead is not None:
            message = f"'overhead' of {callback.name!r} has no effect, because it runs in the executor"
            advice = "Set it at the executor, or set 'runs_in: own-task'."
            context.notes.error("APP003", message, section.location("overhead"), advice)
        if section.core is not None and section.core != executor_core:
            message = f"{callback.name!r} runs in the executor on {executor_core!r}, not on {section.core!r}"
            context.notes.error("UR104", message, section.location("core"), "Remove 'core', or set 'runs_in: own-task'.")
        return executor_core
    if section.core is not None:
        return context.core(section.core, section.location("core"))
    return context.core(node.core, node.location("core"))


def _body(context: AssemblyContext, callback: Callback, executor_core: str) -> Runnable:
    """The runnable of a callback: it reads, computes and publishes, and writes."""
    section, publish = callback.section, context.description.middleware.publish
    sending = [cost for message in callback.outgoing for cost in message_cost(publish, message.size)]
    core = _core(context, callback, executor_core)
    activities = activity_sequence(
        context.converter.execute([section.execution_time, *sending], core, section.location("execution_time")),
        reads=dict.fromkeys([*([callback.buffer] if callback.buffer else []), *section.reads]),
        writes=dict.fromkeys(section.writes),
        sends=[message.channel for message in callback.outgoing if message.channel in context.channels],
    )
    return Runnable(name=body_name(callback.name), activities=activities, callback=callback.in_executor, origin=callback.origin)


def body_name(callback: str) -> str:
    """The name of the runnable of a callback."""
    return f"{callback}_Callback"


def _add_own_task(context: AssemblyContext, callback: Callback, period: Time, body: Runnable) -> None:
    """Add the task of a callback."""
    section = callback.section
    counter = own_task_counter(callback, period) if callback.runs_when_due else None
    context.runnables[body.name] = body
    context.tasks.append(
        PlannedTask(
            name=callback.name,
            core=_core(context, callback, context.controller.first_core),
            stimuli=(context.stimuli.periodic(period, section.offset, callback.origin),),
            activities=(Call(runnable=body.name, counter=counter),),
            period=period,
            priority=section.priority,
            deadline=section.deadline,
            overhead=section.overhead,
            origin=callback.origin,
        )
    )


def add_interrupt(context: AssemblyContext, messages: Sequence[BusMessage]) -> None:
    """Add the interrupt service routine that receives frames, if it is described."""
    can = context.description.middleware.transport.can
    incoming = [message for message in messages if message.incoming]
    if can is None or can.interrupt is None or not incoming:
        return
    bus = bus_of(can)
    stimuli = [context.stimuli.add(receive_stimulus(message, bus)) for message in incoming]
    _add_isr(context, can.interrupt, tuple(stimuli))


def _add_isr(context: AssemblyContext, interrupt: Interrupt, stimuli: tuple[str, ...]) -> None:
    section = interrupt if interrupt.core else context.description.middleware.executor
    core = context.core(section.core, section.location("core"))
    activities = activity_sequence(context.converter.execute([interrupt.execution_time], core, interrupt.location()))
    handler = Runnable(name=f"{interrupt.name}_Frame", activities=activities, origin=interrupt.location())
    context.runnables[handler.name] = handler
    context.isrs.append(
        PlannedIsr(
            name=interrupt.name,
            core=core,
            stimuli=stimuli,
            activities=(Call(runnable=handler.name),),
            priority=interrupt.priority,
            overhead=interrupt.overhead,
            origin=interrupt.location(),
        )
    )
