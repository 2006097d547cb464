"""What activates the task of an iteration: how often iterations can begin at most.

A thread that sleeps begins an iteration when the sleep after the one before has passed. One that only waits begins an iteration for
each message that arrives, each timer that is due, and each timeout; if it does not wait either, whenever the iteration before has
ended.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain

from amalthea_uros.executors.semantics.loops import is_paced, iterations_follow_at_once
from amalthea_uros.perf.distributions import Boundaries, Uniform
from amalthea_uros.perf.executors import Executor, HandleKind, ThreadLoop
from amalthea_uros.perf.stimuli import (
    ArrivalCurve,
    ArrivalCurvePoint,
    Custom,
    InterProcess,
    Periodic,
    RelativePeriodic,
    Stimulus,
)
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.assembly.planned import trigger_name

#: Iterations whose distances are stated; of more, the distances follow from these, a little too short.
_PACED_ITERATIONS = 20


def iteration_trigger_name(executor: str) -> str:
    """The name of the stimulus by which what receives messages begins an iteration of an executor that blocks."""
    return trigger_name(executor)


def message_stimulus_name(callback: str) -> str:
    """The name of the stimulus that stands for the arrival of messages, if nothing that is described receives them."""
    return f"messages_for_{callback}"


def is_triggered(executor: Executor) -> bool:
    """Whether the arrival of a message begins an iteration."""
    return not is_paced(executor) and not iterations_follow_at_once(executor)


def activation(executor: Executor, callbacks: Sequence[Callback], min_iteration: Time, offset: Time) -> Iterator[Stimulus]:
    """The stimuli of the task of an executor.

    Parameters
    ----------
    callbacks : that the executor has handles of
    min_iteration : minimum execution time of an iteration
    offset : time of the first iteration, for a period
    """
    loop, name = executor.loop, f"rounds_of_{executor.name}"
    reason = iterations_follow_at_once(executor)
    if loop.sleep:
        yield _after_sleeps(name, loop, min_iteration)
    elif loop.period is not None and is_paced(executor):
        # An iteration executes when its wait ends. Versions of one middleware differ in whether they wait without anything that
        # receives messages (micro-ROS/rmw_microxrcedds#305), so a wait that returns at once has a jitter, too.
        latest = min(loop.timeout, loop.period)
        yield Periodic(name=name, period=loop.period, offset=offset, jitter=Boundaries(lower=0, upper=latest))
    elif reason:
        unknown = Custom(name=name, description=f"{reason}, and the execution time of an iteration is not specified")
        yield _at_least(name, min_iteration) if min_iteration else unknown
    else:
        yield _at_least(f"timeout_of_{executor.name}", loop.timeout)
        for callback in callbacks:
            yield from _of_callback(executor, callback)


def _of_callback(executor: Executor, callback: Callback) -> Iterator[Stimulus]:
    """What a callback adds to the iterations of an executor that blocks."""
    if callback.kind is HandleKind.TIMER:
        yield _at_least(f"due_{callback.name}", callback.min_interval)
    elif callback.kind is not HandleKind.GUARD_CONDITION or executor.waiting.guard_conditions_end_wait:
        name = message_stimulus_name(callback.name)
        unknown = Custom(name=name, description=f"the rate of {callback.name!r} is not specified")
        yield unknown if callback.interval is None else _at_least(name, callback.min_interval)


def _after_sleeps(name: str, loop: ThreadLoop, min_iteration: Time) -> Stimulus:
    """Iterations between sleeps; the first of several can wait for long, so that the second follows after the shortest sleep."""
    shortest = loop.sleep - loop.sleep_early + min_iteration
    if loop.pace <= shortest:
        return _at_least(name, shortest)
    points = (
        ArrivalCurvePoint(occurrences=2 + more, lower=shortest + more * loop.pace) for more in range(_PACED_ITERATIONS - 1)
    )
    return ArrivalCurve(name=name, points=(ArrivalCurvePoint(occurrences=1, lower=0), *points))


def _at_least(name: str, distance: Time) -> Stimulus:
    # A uniform distribution, as importers of AMALTHEA models know no constant one here.
    return RelativePeriodic(name=name, distance=Uniform(lower=distance, upper=distance), has_maximum=False)


def with_triggered_iterations(system: System) -> System:
    """The system, in which what receives messages triggers the iterations of executors that block, if it is described.

    Interrupts and tasks of the middleware may be added to a system with `Trigger(stimulus=iteration_trigger_name(...))` before; the
    stimuli that stand for the arrival of messages otherwise are then replaced.
    """
    triggered = set(chain.from_iterable(system.triggered))
    for executor in system.executors:
        if iteration_trigger_name(executor.name) in triggered:
            system = _triggered(system, executor)
    return system


def _triggered(system: System, executor: Executor) -> System:
    own = system.processes[executor.task].stimuli
    guards = {handle.name for handle in executor.handles if handle.kind is HandleKind.GUARD_CONDITION}
    kept = set(map(message_stimulus_name, guards))
    replaced = {name for name in own if name.startswith(message_stimulus_name("")) and name not in kept}
    trigger = InterProcess(name=iteration_trigger_name(executor.name), origin=executor.origin)
    stimuli = [each for each in system.stimuli.stimuli if each.name not in replaced]
    begun = (*(name for name in own if name not in replaced), trigger.name)
    # The interrupt in which the operating system activates the task occurs with it.
    tasks = (replace(each, stimuli=begun) if each.stimuli == own else each for each in system.software.tasks)
    isrs = (replace(each, stimuli=begun) if each.stimuli == own else each for each in system.software.isrs)
    return replace(
        system,
        stimuli=replace(system.stimuli, stimuli=(*stimuli, trigger)),
        software=replace(system.software, tasks=tuple(tasks), isrs=tuple(isrs)),
    )
