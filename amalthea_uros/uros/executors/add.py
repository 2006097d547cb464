"""An executor that spins in a loop, added to an assembly: its handles, its runnables, and the task of its iterations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from amalthea_uros.executors.semantics.readiness import others_of_thread
from amalthea_uros.perf.activities import Demand, Execute
from amalthea_uros.perf.distributions import Boundaries, lowest
from amalthea_uros.perf.executors import Executor, Handle, LoopKind, ThreadLoop, WaitBehaviour
from amalthea_uros.perf.software import UNLIMITED, Runnable
from amalthea_uros.spec import executors as spec
from amalthea_uros.spec.loops import LoopSection
from amalthea_uros.spec.os import OsSection
from amalthea_uros.units import SECOND, Time, down, ticks_of_time, up
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.executor_runnables import ExecutorRunnables, spin_name
from amalthea_uros.uros.assembly.planned import PlannedTask
from amalthea_uros.uros.executors.activation import activation
from amalthea_uros.uros.executors.checks import check_executor
from amalthea_uros.uros.executors.handles import handle_names, handles_of, trigger_of
from amalthea_uros.uros.executors.iterations import has_one_message_per_iteration, iteration_activities, polls_before_timers
from amalthea_uros.uros.executors.sleeps import slept
from amalthea_uros.uros.executors.threads import ThreadItems


def add_looping_executor(
    context: AssemblyContext,
    section: spec.ExecutorSection,
    callbacks: Sequence[Callback],
    bodies: Mapping[str, Runnable],
    activates: Mapping[str, Sequence[str]],
    is_alone: bool,
    thread: ThreadItems | None,
    of_thread: Sequence[Callback],
) -> None:
    """Add an executor with a loop, and the task of its iterations.

    Parameters
    ----------
    callbacks : that it has handles of, in their order
    bodies : the runnable of each callback
    activates : the task that it activates for each callback that has one
    is_alone : whether nothing else uses the middleware
    thread : the list that its loop is a part of; None if its section has its own loop
    of_thread : callbacks of all executors of its thread
    """
    core = context.core(section.core, section.location("core"))
    executor = _executor(context, section, callbacks, bodies, activates, thread, core)
    if thread is not None and (busy := _busy_wait(context, executor, thread, core)) is not None:
        executor = replace(executor, busy_wait=busy)
    if polls_before_timers(executor):
        executor = replace(executor, poll=_poll(context, executor, core))
    # Each executor before it in the loop has an iteration between two of its own.
    spins = [each.spin for each in others_of_thread(executor, context.executors)]
    least = sum(_least_time(context.runnables[each], core, context) for each in (executor.spin, *spins))
    exclusive = has_one_message_per_iteration(executor, is_alone)
    check_executor(executor, section, context.description.middleware, context.notes)
    context.executors.append(executor)
    context.tasks.append(
        PlannedTask(
            name=executor.task,
            core=core,
            stimuli=tuple(map(context.stimuli.add, activation(executor, callbacks, least, section.offset))),
            activities=iteration_activities(executor, exclusive=exclusive, poll=executor.poll),
            # Priorities follow the fastest callback.
            period=min((each.min_interval for each in of_thread if each.interval is not None), default=None),
            priority=section.priority,
            deadline=section.deadline,
            activation_limit=1 if executor.loop.sleep and not executor.loop.pace else UNLIMITED,
            overhead=section.overhead,
            wins_ties=True,
            thread="" if executor.place is None else executor.place.thread,
            origin=section.location(),
        )
    )


def _executor(
    context: AssemblyContext,
    section: spec.ExecutorSection,
    callbacks: Sequence[Callback],
    bodies: Mapping[str, Runnable],
    activates: Mapping[str, Sequence[str]],
    thread: ThreadItems | None,
    core: str,
) -> Executor:
    assert section.loop is not None
    middleware = context.description.middleware
    runnables = ExecutorRunnables(executor=section, context=context, core=core)
    spin = runnables.spin(callbacks)
    context.runnables[spin.name] = spin
    handles: list[Handle] = []
    for callback in callbacks:
        take = runnables.take_or_notify(callback, activates.get(callback.name, ()))
        body = bodies[callback.name] if callback.in_executor else take
        for runnable in (take, body):
            if runnable.activities or runnable is body:
                context.runnables[runnable.name] = runnable
        own_take = take if take.activities and callback.in_executor else None
        handles += handles_of(callback, own_take, body, context.profile)
    waiting, os = context.profile.waiting, context.description.os
    return Executor(
        name=section.name,
        task=section.name,
        spin=spin_name(section.name),
        loop=_loop(section.loop, waiting, os) if thread is None else thread.loop(section.name, os),
        handles=tuple(handles),
        trigger=trigger_of(section, {callback.name: handle_names(callback) for callback in callbacks}, context.notes),
        takes_first=section.semantics == "LET",
        waiting=waiting,
        session="session" if middleware.multithread else None,
        place=None if thread is None else thread.place(section.name, os),
        origin=section.location(),
    )


def _loop(section: LoopSection, waiting: WaitBehaviour, os: OsSection) -> ThreadLoop:
    """The loop that a section describes, on an operating system that counts sleeps in ticks.

    See ros2/rclc `rclc/src/rclc/executor.c`: `rclc_executor_spin` is an endless `spin_some`; `rclc_executor_spin_period` calls
    `spin_some` with the timeout of the executor, whatever the period, and then sleeps until the next multiple of the period.
    """
    if section.spin_some is not None:
        least, most, pace = slept(section.sleep, os)
        return ThreadLoop(
            kind=LoopKind.SLEEPING,
            timeout=section.spin_some,
            sleep=most,
            sleep_early=most - least,
            pace=pace if pace > least else 0,
        )
    if section.spin_period is not None:
        timeout = section.timeout if section.timeout is not None else waiting.default_timeout
        return ThreadLoop(kind=LoopKind.PERIODIC, timeout=timeout, period=section.spin_period)
    assert section.spin is not None
    return ThreadLoop(kind=LoopKind.CONTINUOUS, timeout=section.spin)


def _busy_wait(context: AssemblyContext, executor: Executor, thread: ThreadItems, core: str) -> str | None:
    """Add the runnable in which the thread of an executor waits without sleeping; None if it does not."""
    times = thread.busy_wait(executor.name, context.description.os)
    if times is None:
        return None
    frequency, name = context.controller.frequencies[core], f"{executor.name}_Busy_Wait"
    ticks = Boundaries(lower=down(ticks_of_time(times.lower, frequency)), upper=up(ticks_of_time(times.upper, frequency)))
    context.runnables[name] = Runnable(name=name, activities=(Execute(demand=Demand(ticks=ticks)),), origin=executor.origin)
    return name


def _poll(context: AssemblyContext, executor: Executor, core: str) -> str:
    """Add the runnable of iterations without a callback, from the end of a wait until the timer for which it ended is due."""
    most = up(ticks_of_time(executor.waiting.resolution, context.controller.frequencies[core]))
    name = f"{executor.name}_Poll"
    activities = (Execute(demand=Demand(ticks=Boundaries(lower=0, upper=most))),)
    context.runnables[name] = Runnable(name=name, activities=activities, origin=executor.origin)
    return name


def _least_time(runnable: Runnable, core: str, context: AssemblyContext) -> Time:
    """The minimum execution time of a runnable, without accesses to memory."""
    kind = context.controller.core_types[core]
    ticks = 0
    for activity in runnable.activities:
        if isinstance(activity, Execute):
            distribution = dict(activity.demand.by_core_type).get(kind, activity.demand.ticks)
            ticks += (lowest(distribution) or 0) if distribution is not None else 0
    return down(SECOND * ticks / context.controller.frequencies[core])
