"""Systems with an executor that spins in a loop; cores have 1 MHz, so a tick is a microsecond. Handles are given with their costs."""

from dataclasses import replace

from hand_made_systems import Proc, system, ticks

from amalthea_uros.analyze.response_times.propagation import solve
from amalthea_uros.executors.bounds.evaluate import evaluate_executors
from amalthea_uros.executors.semantics.loops import timing_context
from amalthea_uros.perf.activities import Call, Chance, ProbabilitySwitch
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.executors import (
    Executor,
    Handle,
    HandleKind,
    LoopKind,
    Publication,
    ThreadLoop,
    TriggerCondition,
    TriggerKind,
    WaitBehaviour,
)
from amalthea_uros.perf.software import Runnable
from amalthea_uros.perf.stimuli import Periodic, RelativePeriodic, Stimuli
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS

#: `delay(100); rclc_executor_spin_some(&executor, RCL_MS_TO_NS(100))`, the loop of the Arduino examples.
ARDUINO = ThreadLoop(kind=LoopKind.SLEEPING, timeout=100 * MS, sleep=100 * MS)
#: `rclc_executor_spin`, whose timeout is 1 s by default.
SPIN = ThreadLoop(kind=LoopKind.CONTINUOUS, timeout=1000 * MS)


def message(name, interval, cost=0, **parts):
    """A subscription; interval and cost in microseconds."""
    return _handle(name, HandleKind.SUBSCRIPTION, interval, cost, **parts)


def timer(name, period, cost=0, **parts):
    return _handle(name, HandleKind.TIMER, period, cost, **parts)


def guard(name, interval=None, cost=0, **parts):
    return _handle(name, HandleKind.GUARD_CONDITION, interval, cost, **parts)


def _handle(name, kind, interval, cost, **parts):
    handle = Handle(name=name, kind=kind, runnable=f"On_{name}", interval=interval and interval * US, **parts)
    return handle, cost


def waiting_publication(topic="odom", timeout=1000 * MS, **parts):
    return Publication(topic=topic, reliable=True, waits=True, timeout=timeout, **parts)


def looping(*handles, loop=ARDUINO, spin=0, others=(), priority=5, name="Executor", trigger=None, waiting=None, **parts):
    """A system with one executor and other processes on the same core; handles in the order of the executor."""
    executor, process, runnables, stimulus = _parts(name, handles, loop, spin, priority)
    executor = replace(executor, trigger=trigger or TriggerCondition(), waiting=waiting or WaitBehaviour(), **parts)
    found = system(process, *others, runnables=runnables)
    return replace(found, executors=(executor,), stimuli=Stimuli(stimuli=(*found.stimuli.stimuli, stimulus)))


def _parts(name, handles, loop, spin, priority):
    runnables = [Runnable(name=f"{name}_Spin", activities=(ticks(spin),))]
    runnables += [Runnable(name=handle.runnable, callback=True, activities=(ticks(cost),)) for handle, cost in handles]
    body = [Call(runnable=f"{name}_Spin")]
    for handle, _ in handles:
        body.append(
            ProbabilitySwitch(
                branches=(Chance(weight=1.0, activities=(Call(runnable=handle.runnable),)), Chance(weight=1.0, activities=()))
            )
        )
    if loop.kind is LoopKind.PERIODIC:
        stimulus = Periodic(name=f"{name}_loop", period=loop.period)
    else:
        distance = Constant(max(loop.sleep + spin * US, MS))
        stimulus = RelativePeriodic(name=f"{name}_loop", distance=distance, has_maximum=False)
    process = Proc(name, tuple(body), stimuli=(stimulus.name,), priority=priority)
    executor = Executor(name=name, task=name, spin=f"{name}_Spin", loop=loop, handles=tuple(handle for handle, _ in handles))
    return executor, process, tuple(runnables), stimulus


def evaluate(found, sending=None, extra_jitter=None):
    """The result of the first executor of a system."""
    solution = solve(timing_context(found))
    return evaluate_executors(solution, sending=sending or {}, extra_jitter=extra_jitter or {})[0]


def combined(kind, *sets):
    return TriggerCondition(kind=kind, sets=tuple(frozenset(each) for each in sets))


__all__ = [
    "ARDUINO",
    "MS",
    "SPIN",
    "US",
    "Proc",
    "TriggerKind",
    "WaitBehaviour",
    "combined",
    "evaluate",
    "guard",
    "looping",
    "message",
    "ticks",
    "timer",
    "waiting_publication",
]
