"""A condition of a stimulus can suppress any activation: what needs one in each period is unknown, response times are as without it."""

from dataclasses import replace

import pytest
from hand_made_systems import changed
from test_chain_systems import END, START, at, read, system, ticks, write

from amalthea_uros import analyze_system
from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.conditions import Condition, ModeValueIs, Relation
from amalthea_uros.perf.constraints import (
    Bound,
    Constraints,
    LatencyConstraint,
    LatencyKind,
    RepetitionConstraint,
    Requirement,
    TimeLimit,
    TimeMetric,
)
from amalthea_uros.perf.stimuli import InterProcess, Periodic, Stimuli, Synthetic
from amalthea_uros.timing.event_models.derived import rescaled, thinned
from amalthea_uros.timing.event_models.models import PeriodicEvents, can_be_dense, is_strictly_periodic
from amalthea_uros.units import MICROSECOND as US

NOT_YET = Condition(alternatives=((ModeValueIs(label="M", relation=Relation.NOT_EQUAL, value="1"),),))
PERIODIC = Periodic(name="W", period=10 * US, condition=NOT_YET)
SYNTHETIC = Synthetic(name="W", period=10 * US, times=(0,), condition=NOT_YET)
LONG = 10**9 * US


def writer_and_reader(stimulus=PERIODIC, *, is_reader_conditional=False):
    """W writes for 1 and R reads for 1, every 10."""
    built = system([("W", 10, [ticks(1), write("L")]), ("R", 10, [read("L"), ticks(1)])], (at("W", START), at("R", END)))
    reader = replace(built.stimuli.stimuli[1], condition=NOT_YET if is_reader_conditional else None)
    return replace(built, stimuli=Stimuli(stimuli=(stimulus, reader)))


def verdicts(built, *constraints, requirements=()):
    stated = Constraints(constraints=constraints, requirements=requirements)
    return {str(found.verdict) for found in analyze_system(replace(built, constraints=stated)).requirements}


@pytest.mark.parametrize("stimulus", [PERIODIC, SYNTHETIC])
def test_data_of_a_writer_that_may_not_come_grow_old(stimulus):
    age = LatencyConstraint(name="age", chain="chain", kind=LatencyKind.AGE, maximum=LONG)
    assert verdicts(writer_and_reader(stimulus), age) == {"unknown"}
    (found,) = analyze_system(replace(writer_and_reader(stimulus), constraints=Constraints(constraints=(age,)))).requirements
    assert found.reason == "'W' is activated only if the condition of a stimulus is true"
    assert verdicts(writer_and_reader(replace(stimulus, condition=None)), age) == {"met"}


def test_a_reader_that_may_not_come_does_not_react():
    reaction = LatencyConstraint(name="reaction", chain="chain", kind=LatencyKind.REACTION, maximum=LONG)
    assert verdicts(writer_and_reader(is_reader_conditional=True), reaction) == {"unknown"}


@pytest.mark.parametrize("metric", [TimeMetric.ACTIVATE_TO_ACTIVATE, TimeMetric.START_TO_START, TimeMetric.END_TO_END])
def test_distances_of_jobs_have_no_maximum(metric):
    limit = TimeLimit(metric=metric, bound=Bound.UPPER, value=LONG)
    requirement = Requirement(name="distance", process="W", limit=limit)
    assert verdicts(writer_and_reader(), requirements=(requirement,)) == {"unknown"}


@pytest.mark.parametrize(("event", "limits"), [("W start", {"upper": LONG}), ("W start", {"lower": 11 * US})])
def test_repetitions_are_neither_certain_nor_excluded(event, limits):
    assert verdicts(writer_and_reader(), RepetitionConstraint(name="R", event=event, **limits)) == {"unknown"}


def test_a_trigger_into_a_conditional_stimulus_need_not_act():
    stimulus = InterProcess(name="R", condition=NOT_YET)
    tasks = [("W", 10, [Trigger(stimulus="R"), ticks(1)]), ("R", None, [ticks(1)])]
    built = system(tasks, (at("W", START), at("R", END)), stimuli=(stimulus,))
    reaction = LatencyConstraint(name="reaction", chain="chain", kind=LatencyKind.REACTION, maximum=LONG)
    assert verdicts(built, reaction) == {"unknown"}
    always = replace(built, stimuli=Stimuli(stimuli=(built.stimuli.stimuli[0], InterProcess(name="R"))))
    assert verdicts(always, reaction) == {"met"}


def test_only_the_worst_load_has_what_may_be_suppressed():
    (core,) = analyze_system(writer_and_reader()).processors
    # 1 of 10 by R for certain, and 1 of 10 by W at most.
    assert (float(core.best), core.mean, float(core.worst), float(core.at_least)) == (0.1, None, 0.2, 0.1)


def test_suppressed_activations_overload_nothing_for_certain():
    built = writer_and_reader()
    analysis = analyze_system(changed(built, "W", activities=(ticks(20),)))
    assert not analysis.processors["core"].is_overloaded
    assert {str(process.verdict) for process in analysis.processes} == {"unknown"}


def test_response_times_are_as_without_a_condition():
    with_condition, without = (
        analyze_system(writer_and_reader()),
        analyze_system(writer_and_reader(replace(PERIODIC, condition=None))),
    )
    assert (
        [p.response.worst for p in with_condition.processes]
        == [p.response.worst for p in without.processes]
        == [1 * US, 2 * US]
    )


def test_events_that_can_be_suppressed_stay_so_in_another_unit_of_time():
    events = rescaled(thinned(PeriodicEvents(10, 3)), 2)
    assert events.can_be_suppressed
    assert events.max_interarrival is None
    assert not can_be_dense(events)
    assert not is_strictly_periodic(events)
    # 2 * (10 - 3)
    assert events.delta_min(2) == 14
