"""Delays from an event to the next one, where all times are known: exactly what a simulation from the start on observes."""

from dataclasses import replace

import pytest
from effort import examples
from hand_made_systems import Proc, system, ticks
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.constraints import Constraints, DelayConstraint
from amalthea_uros.perf.events import ProcessChange, ProcessEvent
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import Duration

CHANGES = (ProcessChange.ACTIVATE, ProcessChange.START, ProcessChange.TERMINATE)
SOURCE = Proc("S", (ticks(2),), 20, priority=2)


def built(*processes, changes=(ProcessChange.START, ProcessChange.START), triggers=(), **limits):
    """A delay between the given changes of S and T, in microseconds."""
    ends = {"source": "S", "target": "T"}
    events = [
        ProcessEvent(name=end, process=name, change=change) for (end, name), change in zip(ends.items(), changes, strict=True)
    ]
    delay = DelayConstraint(name="D", source="source", target="target", **{k: v * US for k, v in limits.items()})
    return replace(system(*processes, events=tuple(events), triggers=triggers), constraints=Constraints(constraints=(delay,)))


def verdicts(found):
    return {("upper" if item.is_upper else "lower"): str(item.verdict) for item in found.requirements}


@pytest.mark.parametrize(("upper", "verdict"), [(7, "missed"), (8, "met")])
def test_the_longest_wait_for_the_next_target(upper, verdict):
    # S starts at 0, 20, 40, 60; T at 8, 38, 68, between them on its own core.
    target = Proc("T", (ticks(1),), 10, 8, priority=1, scheduler="s1")
    assert verdicts(analyze_system(built(SOURCE, target, upper=upper))) == {"upper": verdict}


@pytest.mark.parametrize(("upper", "verdict"), [(17, "missed"), (18, "met")])
def test_a_target_below_the_lower_limit_is_ignored(upper, verdict):
    target = Proc("T", (ticks(1),), 10, 8, priority=1, scheduler="s1")
    found = verdicts(analyze_system(built(SOURCE, target, lower=9, upper=upper)))
    assert found == {"upper": verdict, "lower": "met"}


def test_how_late_the_next_target_above_a_lower_limit_comes_is_unknown_without_all_times():
    origin = Proc("O", (ticks(1), Trigger(stimulus="t")), 20, priority=3)
    varying = replace(SOURCE, period=0, stimuli=("t",))
    target = Proc("T", (ticks(1),), 10, 8, priority=1, scheduler="s1")
    found = verdicts(analyze_system(built(origin, varying, target, lower=9, upper=18, triggers=("t",))))
    assert found["upper"] == "unknown"


def test_a_target_that_the_source_does_not_cause_will_do():
    # S triggers T after 20 us, T comes every 10 us anyway: no limit is missed because of the job that S triggers.
    source = Proc("S", (ticks(20), Trigger(stimulus="t")), 100, priority=1)
    target = Proc("T", (ticks(1),), 10, stimuli=("t",), priority=1, scheduler="s1", task={"activation_limit": 5})
    changes = (ProcessChange.START, ProcessChange.TERMINATE)
    model = built(source, target, changes=changes, upper=15, triggers=("t",))
    (observed,) = simulate_system(model, Options(duration=Duration(1000 * US))).requirements
    assert str(observed.verdict) == "observed_ok"
    assert verdicts(analyze_system(model)) == {"upper": "unknown"}


@given(
    periods=st.tuples(st.sampled_from((10, 15, 20)), st.sampled_from((10, 15, 30))),
    offsets=st.tuples(st.integers(0, 25), st.integers(0, 25)),
    demands=st.tuples(st.integers(1, 3), st.integers(1, 3)),
    changes=st.tuples(st.sampled_from(CHANGES), st.sampled_from(CHANGES)),
    lower=st.integers(0, 12),
    is_other_core=st.booleans(),
)
@examples(40)
def test_delays_are_those_of_a_simulation(periods, offsets, demands, changes, lower, is_other_core):
    source, target = (
        Proc(name, (ticks(demand),), period, offset, priority=priority, scheduler=scheduler)
        for name, demand, period, offset, priority, scheduler in zip(
            "ST", demands, periods, offsets, (2, 1), ("s0", "s1" if is_other_core else "s0"), strict=True
        )
    )
    model = built(source, target, changes=changes, upper=60, **({"lower": lower} if lower else {}))
    analysis, observed = analyze_system(model), simulate_system(model, Options(duration=Duration(400 * US)))
    proved = next(item for item in analysis.requirements if item.is_upper)
    seen = next(item for item in observed.requirements if item.is_upper)
    assert proved.lower == proved.upper == seen.value
