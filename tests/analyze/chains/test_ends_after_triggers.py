"""Chains that start at the end of a job which has triggered, or written, before: the next job is the first one that responds."""

from dataclasses import replace

import pytest
from hand_made_systems import READ, WRITE, access, changed
from test_chain_systems import END, START, at, evaluate, read, system, ticks

from amalthea_uros import analyze_system
from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.constraints import Constraints, DelayConstraint, Matching
from amalthea_uros.perf.events import LabelChange, LabelEvent
from amalthea_uros.perf.software import Preemption
from amalthea_uros.perf.stimuli import Counter, InterProcess
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Duration


def triggering(cores=("core",), *, constraints=()):
    """R, the higher priority, for 2 at the start of each W, which executes 10 every 100."""
    tasks = [("R", None, [ticks(2)], cores[0]), ("W", 100, [Trigger(stimulus="R"), ticks(10)], cores[-1])]
    built = system(tasks, (at("W", END), at("R", END)), stimuli=(InterProcess(name="R"),), cores=cores)
    return replace(built, constraints=Constraints(constraints=constraints))


@pytest.mark.parametrize(
    ("cores", "least"),
    # W ends at 12 and R at 102; on two cores W ends at 10.
    [(("core",), 90), (("core", "other"), 92)],
)
def test_the_next_job_responds_to_the_end_of_a_job_that_has_triggered(cores, least):
    _, values, _, _ = evaluate(triggering(cores))
    assert 0 < values["min_first_to_first"] <= least <= values["max_reduced_reaction_time"] <= 100


def test_what_cannot_preempt_the_job_responds_after_its_end():
    built = triggering()
    _, values, _, _ = evaluate(changed(built, preemption=Preemption.NON_PREEMPTIVE))
    # W keeps the core up to its end at 10, R executes after that.
    assert values["min_first_to_first"] <= 2


def test_the_simulation_agrees_with_the_analysis():
    built = triggering()
    (chain,) = simulate_system(built, Options(duration=Duration(10 * MS))).chains
    reaction = chain.quantities[ChainQuantity.REDUCED_REACTION_TIME]
    assert reaction.min == reaction.max == 90 * US
    _, values, _, _ = evaluate(built)
    assert values["min_first_to_first"] <= 90 <= values["max_reduced_reaction_time"]


@pytest.mark.parametrize(("matching", "verdict"), [(Matching.REACTION, "missed"), (Matching.ONE_TO_ONE, "unknown")])
def test_a_delay_from_such_an_end(matching, verdict):
    delay = DelayConstraint(name="D", source="W terminate", target="R terminate", upper=50 * US, matching=matching)
    built = triggering(constraints=(delay,))
    assert [str(found.verdict) for found in analyze_system(built).requirements] == [verdict]


def test_what_was_written_before_the_end_does_not_come_from_it():
    # W writes at 0 and ends at 10; the reader of 5 reads that from 0 + 50 at the latest, but what follows the end of W from 100 on.
    tasks = [("W", 100, [access("L", WRITE), ticks(10)]), ("R", 50, [read("L"), ticks(5)])]
    _, values, _, _ = evaluate(system(tasks, (at("W", END), at("R", END))))
    assert values["max_reduced_reaction_time"] >= 105 - 10


def test_what_responds_after_the_end_may_be_meant_as_its_response():
    # R, of lower priority, executes from the end of W at 10 to 12, and after that of the next W from 110 to 112.
    tasks = [("W", 100, [Trigger(stimulus="R"), ticks(10)], "core"), ("R", None, [ticks(2)], "core")]
    built = system(tasks, (at("W", END), at("R", END)), stimuli=(InterProcess(name="R"),))
    _, values, _, _ = evaluate(built)
    assert values["min_first_to_first"] <= 2 < 102 <= values["max_reduced_reaction_time"]


def test_what_is_written_at_the_instant_of_the_end_may_be_meant_by_what_follows_it():
    # W reads S of the job before it, executes 4 and writes S and L at the instant of its end; R reads L every 40, the first time at 4.
    body = [access("S", READ), ticks(4), access("S", WRITE), access("L", WRITE)]
    written = LabelEvent(name="written", label="L", process="W", change=LabelChange.WRITE)
    built = system([("W", 80, body), ("R", 40, [read("L"), ticks(2)])], (at("W", END), written, at("R", END)))
    _, values, _, _ = evaluate(built)
    # R ends at 6; if L of the next W is meant, which has read what this one wrote, at 86.
    assert values["min_first_to_first"] <= 6 - 4 < 86 - 4 <= values["max_reduced_reaction_time"]


# Chains over a trigger that a counter lets have an effect only every second time.


# W, every 100, executes 3 and triggers every second R, which executes 2: 5 after one W, 105 after the other. A counter of the stimulus
# ignores triggers that occur; one of the activity decides which jobs trigger, and others begin no chain.
@pytest.mark.parametrize(("place", "longest"), [("trigger", 5), ("stimulus", 105)])
@pytest.mark.parametrize("offset", [1, 2])
def test_a_trigger_without_effect_waits_for_the_next_one_with_an_effect(place, longest, offset):
    counter = Counter(prescaler=2, offset=offset)
    trigger = Trigger(stimulus="R", counter=counter if place == "trigger" else None)
    stimulus = InterProcess(name="R", counter=counter if place == "stimulus" else None)
    tasks = [("W", 100, [ticks(3), trigger]), ("R", None, [ticks(2)])]
    built = system(tasks, (at("W", START), at("R", END)), stimuli=(stimulus,))
    (chain,) = simulate_system(built, Options(duration=Duration(10 * MS))).chains
    assert chain.quantities[ChainQuantity.REDUCED_REACTION_TIME].max == longest * US
    _, values, _, _ = evaluate(built)
    assert values["min_first_to_first"] <= 5
    assert values["max_reduced_reaction_time"] >= longest
