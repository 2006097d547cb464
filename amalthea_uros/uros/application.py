"""The application: its callbacks in tasks of their own or inside the executor, and the interrupt that receives their messages."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.perf.software import Call, Runnable
from amalthea_uros.spec.middleware import Interrupt
from amalthea_uros.units import Time
from amalthea_uros.uros.callbacks import Callback, in_order
from amalthea_uros.uros.executor import Costs, Part, in_executor_parts, message_cost, occurrences, own_task_parts, timers
from amalthea_uros.uros.periods import Choice, check_inside, choose, choose_executor, offer_of
from amalthea_uros.uros.steps import steps
from amalthea_uros.uros.tasks import PlannedIsr, PlannedTask
from amalthea_uros.uros.work import Work
from amalthea_uros.uros.xrce import Traffic, bus_of, receive_stimulus


def add_callbacks(work: Work, callbacks: Sequence[Callback]) -> tuple[Choice, ...]:
    """Add the executor and the tasks of callbacks, and give the periods that were chosen, that of the executor first."""
    executor, offer = work.description.middleware.executor, offer_of(work.description.middleware)
    outside = [callback for callback in callbacks if not callback.in_executor]
    inside = in_order((callback for callback in callbacks if callback.in_executor), executor, work.notes)
    own = [choice for callback in outside if (choice := choose(callback, offer, work.profile, work.notes)) is not None]
    check_inside(inside, work.profile, work.notes)
    if not own and not inside:
        return ()
    chosen = choose_executor(executor, offer, own, inside, work.notes)
    if chosen is None:
        return ()
    core = work.core(executor.core, executor.location("core"))
    bodies = {callback.name: _body(work, callback, core) for callback in callbacks}
    _add_executor(work, _parts(work, outside, inside, bodies, chosen.period, core), chosen.period, core)
    periods = {choice.task: choice.period for choice in own}
    for callback in outside:
        if callback.name in periods:
            _add_own_task(work, callback, periods[callback.name], bodies[callback.name])
    return (chosen, *own)


def _parts(
    work: Work,
    outside: Sequence[Callback],
    inside: Sequence[Callback],
    bodies: dict[str, Runnable],
    period: Time,
    core: str,
) -> list[Part]:
    """What the executor calls."""
    costs = Costs(middleware=work.description.middleware, profile=work.profile, core=core)
    return [
        Part(runnable=costs.spin(timers((*outside, *inside)))),
        *own_task_parts(outside, costs, period),
        *in_executor_parts(inside, bodies, costs, period),
    ]


def _add_executor(work: Work, parts: Sequence[Part], period: Time, core: str) -> None:
    executor = work.description.middleware.executor
    work.runnables |= {part.runnable.name: part.runnable for part in parts}
    work.tasks.append(
        PlannedTask(
            name=executor.name,
            core=core,
            stimuli=(work.pool.periodic(period, executor.offset, executor.location()),),
            activities=tuple(part.call for part in parts),
            period=period,
            priority=executor.priority,
            deadline=executor.deadline,
            outranks=True,
            origin=executor.location(),
        )
    )


def _core(work: Work, callback: Callback, executor_core: str) -> str:
    """Where a callback runs."""
    section, node = callback.section, callback.node
    if callback.in_executor:
        if section.core is not None and section.core != executor_core:
            message = f"{callback.name!r} runs inside the executor, on {executor_core}"
            advice = "Leave 'core' out, or let it run in a task of its own: 'runs_in: own-task'."
            work.notes.error("UR104", message, section.location("core"), advice)
        return executor_core
    if section.core is not None:
        return work.core(section.core, section.location("core"))
    return work.core(node.core, node.location("core"))


def _body(work: Work, callback: Callback, executor_core: str) -> Runnable:
    """The callback itself: it reads, computes and publishes, and writes."""
    section, publish = callback.section, work.description.middleware.publish
    sending = [cost for message in callback.outgoing for cost in message_cost(publish, message.size)]
    core = _core(work, callback, executor_core)
    activities = steps(
        work.profile.execute([section.execution_time, *sending], core, section.location("execution_time")),
        reads=dict.fromkeys([*([callback.buffer] if callback.buffer else []), *section.reads]),
        writes=dict.fromkeys(section.writes),
    )
    return Runnable(name=body_name(callback), activities=activities, origin=callback.origin)


def body_name(callback: Callback) -> str:
    """The name of the function of a callback."""
    return f"{callback.name}_Callback"


def _add_own_task(work: Work, callback: Callback, period: Time, body: Runnable) -> None:
    """Add the task of a callback; where it is activated more often than the callback is due, it calls every n-th time."""
    section = callback.section
    work.runnables[body.name] = body
    work.tasks.append(
        PlannedTask(
            name=callback.name,
            core=_core(work, callback, work.controller.first_core),
            stimuli=(work.pool.periodic(period, section.offset, callback.origin),),
            activities=(Call(runnable=body.name, counter=occurrences(callback.interval, period)),),
            period=period,
            priority=section.priority,
            deadline=section.deadline,
            origin=callback.origin,
        )
    )


def add_interrupt(work: Work, traffic: Sequence[Traffic]) -> None:
    """Add the interrupt service routine that receives frames, if it is described."""
    can = work.description.middleware.transport.can
    incoming = [item for item in traffic if item.incoming]
    if can is None or can.interrupt is None or not incoming:
        return
    bus = bus_of(can)
    stimuli = [work.pool.add(receive_stimulus(item, bus)) for item in incoming]
    _add_isr(work, can.interrupt, tuple(stimuli))


def _add_isr(work: Work, interrupt: Interrupt, stimuli: tuple[str, ...]) -> None:
    executor = work.description.middleware.executor
    stated, place = (
        (interrupt.core, interrupt.location("core")) if interrupt.core else (executor.core, executor.location("core"))
    )
    core = work.core(stated, place)
    activities = steps(work.profile.execute([interrupt.execution_time], core, interrupt.location()))
    handler = Runnable(name=f"{interrupt.name}_Frame", activities=activities, origin=interrupt.location())
    work.runnables[handler.name] = handler
    work.isrs.append(
        PlannedIsr(
            name=interrupt.name,
            core=core,
            stimuli=stimuli,
            activities=(Call(runnable=handler.name),),
            priority=interrupt.priority,
            origin=interrupt.location(),
        )
    )
