"""Callbacks of executors that a model lets send a message at other places than once at their end, compared with simulations."""

from dataclasses import replace

import pytest

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Call, Chance, Group, ProbabilitySwitch, Trigger
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import MILLISECOND, SECOND, Duration
from amalthea_uros.uros.described import describe_text

MESSAGE = "out_topic_from_C"
#: A callback of 30 ms: if it sends at its end, its messages are 30 ms apart at least.
APPLICATION = """\
amuros: 1
name: Places
hardware: {{platform: single-core, frequency: 1 GHz}}
os: {{tick: 1 ms}}
middleware:
  executors: [{{name: E, priority: 50, execution_time: {{base: 20 us}}, loop: {{spin_some: 1 ms, sleep: 1 ms}}}}]
  transport: {{serial: {{baud_rate: 921600, driver: {{write: dma, read: interrupt}}}}}}
  agent:
    to_controller: {{min: 0 ns, max: 1 us}}
    to_host: {{min: 0 ns, max: 1 us}}
application:
  nodes:
    - name: node
      publishers: [{{topic: out, message_size: 4 B, reliability: best-effort}}]
      {kind}s: [{{name: C, execution_time: 30 ms, publishes: [out], {key}}}]
tasks: [{{name: T, period: 20 ms, priority: 60, execution_time: 10 us}}]
"""
KINDS = {"timer": "period: 40 ms", "subscription": "interval: 40 ms, topic: in, message_size: 4 B, reliability: best-effort"}


def described(kind):
    return describe_text(APPLICATION.format(kind=kind, key=KINDS[kind])).assembly.system


def sending(place, system):
    """The system with a callback that sends somewhere else."""
    (callback,) = (system.runnables[handle.runnable] for handle in system.executors[0].handles)
    work = tuple(each for each in callback.activities if not isinstance(each, Trigger))
    send = Trigger(stimulus=system.processes[MESSAGE].stimuli[0])
    changed = replace(callback, activities=place(send, work))
    runnables = tuple(changed if each.name == callback.name else each for each in system.software.runnables)
    return replace(system, software=replace(system.software, runnables=runnables))


def either(send, work):
    return (ProbabilitySwitch(branches=tuple(Chance(weight=1.0, activities=each) for each in ((send, *work), (*work, send)))),)


def in_any_order(send, work):
    return (Group(activities=(send, *work), ordered=False),)


def twice(send, work):
    return (send, *work, send)


def distances(system):
    """The least distance of two messages by the analysis, and of a simulation."""
    observed = simulate_system(system, Options(duration=Duration(3 * SECOND), seed=1))[MESSAGE]
    return analyze_system(system).processes[MESSAGE].min_interarrival, observed.metrics[JobMetric.ACTIVATE_TO_ACTIVATE].min


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("place", [either, in_any_order, twice])
def test_messages_of_several_places_are_not_a_callback_apart(place, kind):
    bound, observed = distances(sending(place, described(kind)))
    assert bound <= observed
    assert bound < 30 * MILLISECOND


@pytest.mark.parametrize("kind", KINDS)
def test_messages_of_one_place_are_a_callback_apart(kind):
    bound, observed = distances(described(kind))
    assert 30 * MILLISECOND <= bound <= observed


def test_it_is_unknown_when_a_callback_sends_that_a_task_calls_too():
    system = described("timer")
    (callback,) = (handle.runnable for handle in system.executors[0].handles)
    calling = [
        replace(each, activities=(*each.activities, Call(runnable=callback))) if each.name == "T" else each
        for each in system.software.tasks
    ]
    assert (
        analyze_system(replace(system, software=replace(system.software, tasks=tuple(calling))))
        .processes[MESSAGE]
        .min_interarrival
        is None
    )
