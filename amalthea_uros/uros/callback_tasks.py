"""The application: its callbacks in their own tasks or in executors, and the interrupt that receives their messages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.network import Direction
from amalthea_uros.perf.software import Runnable
from amalthea_uros.perf.stimuli import Counter, InterProcess
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.units import Time
from amalthea_uros.uros.application.callbacks import Callback, body_name, registration_order
from amalthea_uros.uros.application.phases import ExecutorPhases, own_task_counter
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.executor_runnables import (
    AT_ONCE,
    ExecutorRunnables,
    PlannedCall,
    in_executor_calls,
    message_cost,
    own_task_calls,
)
from amalthea_uros.uros.assembly.planned import PlannedTask, activity_sequence, trigger_name
from amalthea_uros.uros.executors.add import add_looping_executor
from amalthea_uros.uros.executors.checks import check_order, check_threads
from amalthea_uros.uros.executors.threads import (
    ThreadItems,
    check_threads_of_loops,
    executors_of_loops,
    in_thread_order,
    threads_by_executor,
    threads_of,
)
from amalthea_uros.uros.periods import (
    PeriodChoice,
    check_callbacks_in_executor,
    choose_executor_period,
    choose_task_period,
    period_candidates,
)
from amalthea_uros.uros.transports.messages import driver_costs


def add_callbacks(context: AssemblyContext, callbacks: Sequence[Callback]) -> tuple[PeriodChoice, ...]:
    """Add the executors and the callbacks' own tasks, and return the choice of their periods, that of each executor first."""
    choices: list[PeriodChoice] = []
    middleware = context.description.middleware
    executors = middleware.stated_executors
    check_threads_of_loops(middleware, context.notes)
    by_name, threads = executors_of_loops(middleware), threads_by_executor(middleware)
    served: dict[str, list[Callback]] = {}
    for callback in callbacks:
        served.setdefault(callback.executor, []).append(callback)
    for executor in map(by_name.__getitem__, in_thread_order(by_name, threads)):
        own, thread = served.get(executor.name, []), threads.get(executor.name)
        inside = [callback for callback in own if callback.in_executor]
        ordered = registration_order(inside if executor.loop is None else own, executor, context.notes)
        check_order(executor, context.notes)
        if not own and not executor.states("order") and (executor.loop is not None or len(executors) > 1):
            advice = f"Set 'runs_in: {executor.name}' at callbacks or nodes, or remove the executor."
            context.notes.error("APP003", f"the executor {executor.name!r} serves no callback", executor.location(), advice)
        elif executor.loop is not None:
            choices += _add_looping(context, executor, ordered, thread, _of_thread(thread, served) if thread else own)
        else:
            choices += _add_periodic(context, executor, own, ordered)
    loops = threads_of([executor for executor in executors if executor.loop is not None], threads)
    periodic = [executor.name for executor in executors if executor.loop is None]
    if loops:
        sending = [callback for callback in callbacks if not callback.in_executor and callback.outgoing]
        if not context.profile.sending.is_protected:
            check_threads([*loops, *periodic], sending, middleware, context.notes)
    return tuple(choices)


def _of_thread(thread: ThreadItems, served: Mapping[str, Sequence[Callback]]) -> Sequence[Callback]:
    """The callbacks that a thread serves."""
    return [callback for name in thread.executors for callback in served.get(name, ())]


def _add_looping(
    context: AssemblyContext,
    executor: ExecutorSection,
    callbacks: Sequence[Callback],
    thread: ThreadItems | None,
    of_thread: Sequence[Callback],
) -> Iterator[PeriodChoice]:
    """Add an executor with a loop, and the tasks of callbacks that do not run in it: it activates those without a period.

    Parameters
    ----------
    callbacks : that it serves
    thread : the list that its loop is a part of; None if its section has its own loop
    of_thread : those that its thread serves
    """
    core = context.core(executor.core, executor.location("core"))
    bodies = {callback.name: _body(context, callback, core) for callback in callbacks}
    outside = [callback for callback in callbacks if not callback.in_executor]
    triggered = {callback.name: (callback.name,) for callback in outside if callback.section.task_period is None}
    is_alone = (
        len(context.description.middleware.stated_executors) == 1
        and not any(each.outgoing for each in outside)
        and not any(map(_reads_itself, of_thread))
    )
    add_looping_executor(context, executor, callbacks, bodies, triggered, is_alone, thread, of_thread)
    for callback in outside:
        if callback.name in triggered:
            _add_triggered_task(context, callback, bodies[callback.name])
        elif callback.interval is not None:
            candidates = period_candidates(context.description.middleware, executor)
            choice = choose_task_period(callback, candidates, context.converter, context.notes)
            if choice is not None:
                _add_own_task(context, callback, choice.period, bodies[callback.name])
                yield choice


def _reads_itself(callback: Callback) -> bool:
    """Whether a loop reads messages while it waits for an answer to what it sends outside of callbacks."""
    is_answered = any(message.reliable or message.timeout is not None for message in callback.outgoing)
    return callback.kind is HandleKind.LOOP_ITEM and is_answered


def _add_periodic(
    context: AssemblyContext, executor: ExecutorSection, callbacks: Sequence[Callback], inside: Sequence[Callback]
) -> tuple[PeriodChoice, ...]:
    """Add an executor that is activated with a period, and the tasks of callbacks that do not run in it.

    Parameters
    ----------
    callbacks : that it serves
    inside : those that run in it, in their order
    """
    converter, notes = context.converter, context.notes
    outside = [callback for callback in callbacks if not callback.in_executor]
    candidates = period_candidates(context.description.middleware, executor)
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
    phases = ExecutorPhases.of(executor, chosen.period, callbacks)
    runnables = ExecutorRunnables(executor=executor, context=context, core=core)
    calls = [
        PlannedCall(runnable=runnables.spin((*outside, *inside))),
        *own_task_calls(outside, runnables, phases),
        *in_executor_calls(inside, bodies, runnables, phases),
    ]
    _add_executor(context, executor, calls, chosen.period, core)
    periods = {choice.task: choice.period for choice in choices}
    for callback in outside:
        if callback.name in periods:
            _add_own_task(context, callback, periods[callback.name], bodies[callback.name])
    calls_of_tasks = [call for task in context.tasks for call in task.activities if isinstance(call, Call)]
    counted = {call.counter.source for call in calls_of_tasks if call.counter is not None}
    for callback in callbacks:
        phases.check(callback, callback.name in counted, notes)
    return (chosen, *choices)


def _add_executor(
    context: AssemblyContext, executor: ExecutorSection, calls: Sequence[PlannedCall], period: Time, core: str
) -> None:
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
        for key in ("overhead", "stack"):
            if getattr(section, key) is not None:
                message = f"{key!r} of {callback.name!r} has no effect, because it runs in the executor"
                advice = "Set it at the executor, or set 'runs_in: own-task'."
                context.notes.error("APP003", message, section.location(key), advice)
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
    sending += driver_costs(context.line, callback, Direction.TO_AGENT, context.profile)
    core = _core(context, callback, executor_core)
    execution = context.converter.execute([section.execution_time, *sending], core, section.location("execution_time"))
    activities = activity_sequence(
        AT_ONCE if not execution and callback.kind is HandleKind.LOOP_ITEM else execution,
        reads=dict.fromkeys([*([callback.buffer] if callback.buffer else []), *section.reads]),
        writes=dict.fromkeys(section.writes),
        sends=[message.channel for message in callback.outgoing if message.channel in context.channels],
    )
    return Runnable(name=body_name(callback.name), activities=activities, callback=callback.in_executor, origin=callback.origin)


def _add_own_task(context: AssemblyContext, callback: Callback, period: Time, body: Runnable) -> None:
    """Add the task of a callback that a period activates."""
    stimulus = context.stimuli.periodic(period, callback.section.offset, callback.origin)
    counter = own_task_counter(callback, period) if callback.runs_when_due else None
    _add_task(context, callback, body, stimulus, period, counter)


def _add_triggered_task(context: AssemblyContext, callback: Callback, body: Runnable) -> None:
    """Add the task of a callback that its executor activates when it has taken the message."""
    for key in ("runs_when", "offset"):
        if callback.section.states(key):
            message = f"{key!r} of {callback.name!r} has no effect: its executor activates its task when it is due"
            advice = f"Remove {key!r}, or set 'task_period'."
            context.notes.error("APP003", message, callback.section.location(key), advice)
    stimulus = context.stimuli.add(InterProcess(name=trigger_name(callback.name), origin=callback.origin))
    _add_task(context, callback, body, stimulus, None if callback.interval is None else callback.min_interval)


def _add_task(
    context: AssemblyContext,
    callback: Callback,
    body: Runnable,
    stimulus: str,
    period: Time | None,
    counter: Counter | None = None,
) -> None:
    section = callback.section
    context.runnables[body.name] = body
    context.tasks.append(
        PlannedTask(
            name=callback.name,
            core=_core(context, callback, context.controller.first_core),
            stimuli=(stimulus,),
            activities=(Call(runnable=body.name, counter=counter),),
            period=period,
            priority=section.priority,
            deadline=section.deadline,
            overhead=section.overhead,
            origin=callback.origin,
        )
    )
