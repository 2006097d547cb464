"""Servers on a core and in each other, with tasks of every preemption beside and below them: no response exceeds its bound."""

from dataclasses import replace

import pytest
from effort import examples
from fuzzing.contradictions import contradictions
from hand_made_systems import ticks
from hypothesis import given
from hypothesis import strategies as st
from test_policies import root, system, under, worst

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Group
from amalthea_uros.perf.os import Policy
from amalthea_uros.perf.software import Preemption
from amalthea_uros.perf.stimuli import Periodic, Stimuli
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import Duration

POLICIES = st.sampled_from([Policy.DEFERRABLE_SERVER, Policy.POLLING_SERVER, Policy.SPORADIC_SERVER])
PRIORITIES = st.integers(1, 9)


@st.composite
def systems(draw):
    parents, schedulers = ["root"], [root()]
    for number in range(draw(st.integers(1, 3))):
        parent, name = draw(st.sampled_from(parents)), f"V{number}"
        # Inner servers need less, so that their budgets fit.
        capacity, period = (st.integers(3, 7), (10, 12, 20)) if parent == "root" else (st.integers(1, 4), (20, 24, 40))
        stated = {"capacity": draw(capacity), "period": draw(st.sampled_from(period))}
        schedulers.append(under(name, draw(POLICIES), draw(PRIORITIES), parent=parent, **stated))
        parents.append(name)
    bodies = st.tuples(st.integers(1, 5).map(ticks), st.just(None) | st.integers(1, 4))
    tasks = []
    for number in range(draw(st.integers(2, 4))):
        plain, kept = draw(bodies)
        body = [plain, *([Group(activities=(ticks(kept),), interruptible=False)] if kept else [])]
        allocation = {"scheduler": draw(st.sampled_from(parents)), "priority": draw(PRIORITIES)}
        tasks.append((f"T{number}", draw(st.sampled_from((40, 60, 80, 120))), body, allocation))
    built = system(schedulers, tasks)
    periodic = tuple(
        Periodic(name=stimulus.name, period=stimulus.distance.lower, offset=draw(st.integers(0, 30)) * US)
        for stimulus in built.stimuli.stimuli
    )
    modes = tuple(
        replace(task, preemption=draw(st.sampled_from(Preemption)), activation_limit=99) for task in built.software.tasks
    )
    return replace(built, stimuli=Stimuli(stimuli=periodic), software=replace(built.software, tasks=modes))


@examples(40)
@given(systems())
def test_no_simulated_response_exceeds_its_bound(built):
    simulation = simulate_system(built, Options(duration=Duration(2000 * US), mode=Mode.WORST))
    assert list(contradictions(analyze_system(built), simulation)) == []


@pytest.mark.parametrize(("outer", "inner"), [(None, 3), (3, None)])
def test_a_task_beside_a_server_and_no_order_between_them(outer, inner):
    tasks = [
        ("beside", 100, [ticks(1)], {"scheduler": "V0", "priority": outer}),
        ("inside", 100, [ticks(1)], {"scheduler": "V1", "priority": 1}),
    ]
    servers = [
        under("V0", Policy.POLLING_SERVER, 5, capacity=5, period=10),
        under("V1", Policy.POLLING_SERVER, inner, parent="V0", capacity=2, period=40),
    ]
    found = worst(system([root(), *servers], tasks))
    assert all(isinstance(reason, str) for reason in found.values())
