"""Chains and limits from the start of the system on: the first jobs can wait for longer for each other than later ones."""

from dataclasses import replace

import pytest
from test_chain_systems import END, START, at, evaluate, read, system, ticks, write

from amalthea_uros import analyze_system
from amalthea_uros.perf.constraints import Constraints, DelayConstraint, EventSynchronization, RepetitionConstraint
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.stimuli import Periodic, Stimuli, Synthetic
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.timing.event_models.stimuli import event_model_of
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Duration


def first_alone(offset, period=14):
    """W starts at 0 for 2 every 28; R reads for 6 every period, from its offset on, above W."""
    tasks = [("R", period, [read("L"), ticks(6)], "core", offset), ("W", 28, [write("L"), ticks(2)])]
    return system(tasks, (at("W", START), at("R", END)))


@pytest.mark.parametrize(
    ("offset", "reaction"),
    [
        # W writes at 2 and R ends at 16; later, W starts behind R at 28 + 2, and R at 38 ends at 44.
        (10, 16),
        # The first R comes whole periods of R later.
        (38, 44),
    ],
)
def test_the_first_job_waits_for_a_later_one(offset, reaction):
    built = first_alone(offset)
    _chain, values, claims, _ = evaluate(built)
    assert (values["max_reduced_reaction_time"], claims) == (reaction, {"exact"})
    (observed,) = simulate_system(built, Options(duration=Duration(1 * MS))).chains
    assert observed.quantities[ChainQuantity.REDUCED_REACTION_TIME].max == reaction * US


@pytest.mark.parametrize("offset", [10, 38])
def test_inputs_count_from_the_start_on(offset):
    # The first input reaches the end later than each of the others, whether it is the last one until then or not.
    built = first_alone(offset)
    _chain, values, _, _ = evaluate(built)
    (observed,) = simulate_system(built, Options(duration=Duration(1 * MS))).chains
    for name in ("last_to_first", "first_to_last"):
        assert values[f"max_{name}"] * US == observed.quantities[ChainQuantity(name)].max


def limited(built, constraint):
    (found,) = analyze_system(replace(built, constraints=Constraints(constraints=(constraint,)))).requirements
    return str(found.verdict)


@pytest.mark.parametrize(("upper", "verdict"), [(15, "missed"), (16, "met")])
def test_a_delay_limit_covers_the_start(upper, verdict):
    delay = DelayConstraint(name="D", source="W start", target="R terminate", upper=upper * US)
    assert limited(first_alone(10), delay) == verdict


@pytest.mark.parametrize(
    "stimulus",
    [
        Periodic(name="R", period=14 * US, offset=100 * US, jitter=Uniform(lower=0, upper=1 * US)),
        Synthetic(name="R", period=14 * US, times=(100 * US,)),
        Synthetic(name="R", period=14 * US, times=(5 * US,), offset=95 * US),
    ],
)
def test_bounds_by_periods_cover_the_start(stimulus):
    # W writes at 2, the first R comes at 100 and ends at 106, or, with jitter, up to 1 later.
    built = first_alone(10)
    others = tuple(each for each in built.stimuli.stimuli if each.name != "R")
    built = replace(built, stimuli=Stimuli(stimuli=(*others, stimulus)))
    _, values, _, _ = evaluate(built)
    assert values["max_reduced_reaction_time"] >= 106


def test_times_of_later_periods_are_missing_at_first():
    # At 100, 580, 900, 1060, 1380 and so on: 480 once, later 160 and 320 in turn.
    stimulus = Synthetic(name="R", period=480 * US, times=(100 * US, 900 * US))
    built = first_alone(10)
    built = replace(built, stimuli=Stimuli(stimuli=(stimulus, built.stimuli.stimuli[1])))
    assert event_model_of(stimulus, built).max_interarrival == 480 * US
    assert limited(built, RepetitionConstraint(name="R", event="R terminate", upper=479 * US)) == "unknown"
    # R has the highest priority and needs 6 in each job.
    assert limited(built, RepetitionConstraint(name="R", event="R terminate", upper=480 * US)) == "met"


def test_events_that_first_occur_in_different_periods_are_not_synchronized():
    tasks = [("A", 10, [ticks(1)]), ("B", 10, [ticks(1)], "core", 20)]
    built = system(tasks, (at("A", START), at("B", START)))
    synchronization = EventSynchronization(name="S", events=("A start", "B start"), tolerance=5 * US)
    assert limited(built, synchronization) == "unknown"
