"""How modes choose values, and what the seed decides."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hand_made_systems import Proc, system, ticks
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

from amalthea_uros import describe
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Call, Chance, Count, Demand, Execute, Group, ProbabilitySwitch
from amalthea_uros.perf.distributions import (
    Beta,
    Boundaries,
    Bucket,
    Constant,
    Gauss,
    Histogram,
    Sampling,
    Statistics,
    Uniform,
    Weibull,
)
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import OperatingSystem, Policy, Scheduler
from amalthea_uros.perf.software import Runnable, Task
from amalthea_uros.perf.stimuli import Counter, Periodic
from amalthea_uros.simulate.kernel import machine_code
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import SECOND, Duration


def between(low, average, high):
    """Distributions between two values."""
    return st.sampled_from(
        [
            Constant(average),
            *(Boundaries(lower=low, upper=high, sampling=sampling) for sampling in Sampling),
            Statistics(lower=low, average=float(average), upper=high),
            Uniform(lower=low, upper=high),
            Gauss(mean=float(average), deviation=2.0, lower=low, upper=high),
            Weibull(lower=low, average=float(average), upper=high),
            Beta(alpha=2.0, beta=3.0, lower=low, upper=high),
            Histogram((Bucket(lower=low, upper=average, occurrences=3), Bucket(lower=average, upper=high, occurrences=1))),
        ]
    )


DEMANDS = st.tuples(st.integers(0, 20), st.integers(1, 10), st.integers(1, 30)).flatmap(
    lambda drawn: between(drawn[0], drawn[0] + drawn[1], drawn[0] + drawn[1] + drawn[2])
)
EXECUTE = DEMANDS.map(lambda distribution: Execute(demand=Demand(ticks=distribution)))
CALLS = st.sampled_from([Call(runnable="work"), Call(runnable="work", times=Count(least=0, mean=1.5, most=4))])
# Not within branches: how often a job reaches such a call depends on the branches that are taken, and so the demand of single jobs.
COUNTED = st.just(Call(runnable="work", counter=Counter(prescaler=3, offset=1)))


def nested(inner):
    several = st.lists(inner, min_size=1, max_size=3).map(tuple)
    branches = st.lists(st.builds(Chance, weight=st.sampled_from([0.5, 1.0, 3.0]), activities=several), min_size=1, max_size=3)
    return st.one_of(
        st.builds(Group, activities=several, ordered=st.booleans(), interruptible=st.booleans()),
        st.builds(ProbabilitySwitch, branches=branches.map(tuple)),
    )


BODIES = st.lists(st.recursive(EXECUTE | CALLS, nested, max_leaves=6) | COUNTED, min_size=1, max_size=4)


@given(BODIES, EXECUTE, st.integers(0, 100))
def test_net_execution_times_are_ordered_by_the_modes(body, called, seed):
    runnables = (Runnable(name="work", activities=(called,)),)
    model = system(Proc("task", tuple(body), 2000, priority=1), runnables=runnables)
    found = {
        mode: simulate_system(model, Options(duration=Duration(100 * MS), mode=mode, seed=seed))["task"].metrics[
            JobMetric.RUNNING_TIME
        ]
        for mode in Mode
    }
    best, worst = found[Mode.BEST], found[Mode.WORST]
    for mode in (Mode.SAMPLED, Mode.AVERAGE):
        assert best.min <= found[mode].min
        assert found[mode].max <= worst.max
        assert best.mean <= found[mode].mean <= worst.mean
    bounds = analyze_system(model).processes["task"]
    assert bounds.bcet <= best.min
    assert worst.max <= bounds.wcet


def is_skewed(distribution):
    """AMALTHEA defines the middle as the average of boundaries, also where it says that most values are near one of them."""
    return isinstance(distribution, Boundaries) and distribution.sampling in (Sampling.BEST_CASE, Sampling.WORST_CASE)


@given(DEMANDS.filter(lambda distribution: not is_skewed(distribution)))
def test_the_average_of_many_samples_is_near_the_average_mode(distribution):
    model = system(Proc("task", (Execute(demand=Demand(ticks=distribution)),), 100, priority=1))
    found = {
        mode: simulate_system(model, Options(duration=Duration(100 * MS), mode=mode))["task"].metrics[JobMetric.RUNNING_TIME]
        for mode in (Mode.SAMPLED, Mode.AVERAGE)
    }
    sampled, average = found[Mode.SAMPLED], found[Mode.AVERAGE]
    assert average.min == average.max
    # 1000 samples: five standard errors, and a tick of which only whole numbers exist.
    assert abs(sampled.mean - average.mean) <= 5 * Fraction(sampled.std) / 31 + US


DRIVE = describe(ROOT / "samples" / "drive-and-lift.yaml").system_with_bus()


def played(seed=1, system=DRIVE, mode=Mode.SAMPLED, duration=SECOND // 5):
    return simulate_system(system, Options(duration=Duration(duration), seed=seed, mode=mode))


def values(simulation):
    """Everything that was observed, except what it was observed with."""
    return (simulation.cores, list(simulation.processes), list(simulation.chains), list(simulation.requirements))


def test_the_same_seed_gives_the_same_values_and_another_seed_others():
    first, again, other = played(1), played(1), played(2)
    assert values(first) == values(again)
    varying = ["Control_Speed", "Control_Lift", "Wheel_Pulse", "speed_topic_to_Set_Speed"]
    # The net execution times, or for the ISR, whose time is constant, the number of jobs.
    assert [name for name in varying if (first[name].load, first[name].jobs) == (other[name].load, other[name].jobs)] == []


@pytest.mark.parametrize("mode", [Mode.WORST, Mode.BEST])
def test_without_samples_only_phases_depend_on_the_seed(mode):
    assert values(played(1, mode=mode)) == values(played(2, mode=mode))


@pytest.mark.parametrize("mode", Mode)
def test_a_task_on_another_core_changes_nothing(mode):
    stimulus = Periodic(name="other timer", period=3 * MS)
    demand = Demand(ticks=Uniform(lower=1, upper=10_000))
    task = Task(name="other", stimuli=(stimulus.name,), activities=(Execute(demand=demand),))
    scheduler = Scheduler(name="other scheduler", policy=Policy.OSEK, cores=("Core_3",))
    system = replace(
        DRIVE,
        os=replace(DRIVE.os, systems=(*DRIVE.os.systems, OperatingSystem(name="other OS", schedulers=(scheduler,)))),
        stimuli=replace(DRIVE.stimuli, stimuli=(stimulus, *DRIVE.stimuli.stimuli)),
        software=replace(DRIVE.software, tasks=(task, *DRIVE.software.tasks)),
        mapping=replace(
            DRIVE.mapping, tasks=(TaskAllocation(task="other", scheduler=scheduler.name, priority=1), *DRIVE.mapping.tasks)
        ),
    )
    alone, together = played(mode=mode), played(system=system, mode=mode)
    assert together["other"].jobs == 67
    assert [process for process in together.processes if process.name != "other"] == list(alone.processes)
    assert list(together.chains) == list(alone.chains)


def test_a_task_of_lower_priority_does_not_change_what_others_draw():
    varying = (Execute(demand=Demand(ticks=Uniform(lower=1, upper=50))),)
    high, low = Proc("high", varying, 100, priority=2), Proc("low", varying, 150, priority=1)
    isr = Proc("isr", (ticks(3),), 130, priority=1, is_isr=True)
    alone, together = (
        simulate_system(system(*found, isr), Options(duration=Duration(50 * MS))) for found in ((high,), (high, low))
    )
    assert together["high"] == alone["high"]


@pytest.mark.early
@pytest.mark.parametrize("mode", Mode)
def test_machine_code_does_the_same_as_the_interpreter(mode, monkeypatch):
    pytest.importorskip("numba")
    found = []
    for is_compiled in (False, True):
        monkeypatch.setattr(machine_code, "is_worth_it", lambda _seconds, _seconds_left, answer=is_compiled: answer)
        found.append(played(mode=mode).record())
    assert found[0] == found[1]
