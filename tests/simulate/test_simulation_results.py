"""Results of simulations as objects, records and data frames; verdicts on what was observed."""

from dataclasses import replace
from fractions import Fraction

import pytest
from simulations import CHAIN, CONTROL, EXECUTOR, SIMULATION, latencies, observation, process

from amalthea_uros._internal.by_name import Results
from amalthea_uros.judge.limits import Deadline, deadline_of
from amalthea_uros.judge.verdict import ObservedVerdict
from amalthea_uros.perf.constraints import (
    Bound,
    Constraints,
    CountLimit,
    CountMetric,
    DelayConstraint,
    JitterLimit,
    LatencyConstraint,
    LatencyKind,
    LoadLimit,
    LoadMetric,
    OrderConstraint,
    RatioLimit,
    RatioMetric,
    Requirement,
    TimeLimit,
    TimeMetric,
)
from amalthea_uros.perf.mapping import Mapping, TaskAllocation
from amalthea_uros.perf.software import Software, Task
from amalthea_uros.perf.stimuli import Periodic, Stimuli
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.observations import ChainObservation, CountObservation, RunnableObservation
from amalthea_uros.simulate.runs.observed_limits import judge_process, judge_requirements
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import SECOND

CALLBACK = RunnableObservation(
    name="Callback",
    executions=300,
    metrics={JobMetric.RESPONSE_TIME: observation(2 * US, 5 * US, 9 * US)},
    preemptions=CountObservation(total=7, min=0, max=2),
    migrations=CountObservation(total=0, min=0, max=0),
)
OK, MISSED, NOT_OBSERVED = ObservedVerdict.OK, ObservedVerdict.MISSED, ObservedVerdict.NOT_OBSERVED


# Objects and tables


def test_results_are_found_by_name():
    assert SIMULATION["Control"] is CONTROL
    with pytest.raises(KeyError, match="did you mean 'Control'"):
        SIMULATION["Contrl"]


def test_a_simulation_is_short_when_printed():
    assert repr(SIMULATION) == "<Simulation of 300 s, sampled, seed 7: 600 jobs, 0 missed>"


def test_what_is_left_up_to_a_deadline():
    response = CONTROL.response_time
    left, beyond = response.up_to(MS), response.beyond(MS)
    assert (left.min, left.mean, left.max) == (MS - response.max, MS - response.mean, MS - response.min)
    assert (beyond.min, beyond.mean, beyond.max) == (-left.max, -left.mean, -left.min)
    assert left.at_min == response.at_max
    assert left.jitter == beyond.jitter == response.jitter == 13 * US


def test_a_record_has_one_cell_for_each_value():
    record = SIMULATION.record()
    assert record["seed"] == 7
    assert record["duration_ps"] == 300 * SECOND
    assert record["Control.response_time.max_ps"] == 29 * US
    assert record["Control.response_time.avg_ps"] == 16_650_000
    assert record["way.reduced_reaction_time.max_ps"] == 20 * MS
    assert record["Core.core_load"] == pytest.approx(0.0167)
    assert record["lost_activations"] == 0
    assert all(isinstance(cell, int | float | str | None) for cell in record.values())


def test_of_several_limits_with_one_name_a_record_has_the_worst_verdict():
    kept, missed = (limited(TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=value * US)) for value in (30, 28))
    record = replace(SIMULATION, requirements=Results([missed, kept])).record()
    assert record["R.response_time.verdict"] == "observed_missed"
    assert record["Control.verdict"] == "observed_ok"


def test_times_that_are_no_whole_picoseconds_are_rounded_to_the_nearest_one():
    third = process("T", (Fraction(10, 3), Fraction(11, 3), Fraction(4)))
    record = replace(SIMULATION, processes=Results([third])).record()
    assert [record[f"T.response_time.{name}_ps"] for name in ("min", "avg", "max")] == [3, 4, 4]


def test_a_data_frame_has_a_row_for_each_metric():
    pytest.importorskip("pandas")
    frame = SIMULATION.to_dataframe()
    row = frame[(frame["object"] == "Control") & (frame["quantity"] == "response_time")].iloc[0]
    assert (row["count"], row["min_ps"], row["max_ps"]) == (300, 16 * US, 29 * US)


def test_without_pandas_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    with pytest.raises(ImportError, match=r"pip install amuros\[pandas\]"):
        SIMULATION.to_dataframe()


# Deadlines


def system(constraints=(), **allocation):
    return System(
        stimuli=Stimuli(stimuli=(Periodic(name="every 1 ms", period=MS),)),
        software=Software(tasks=(Task(name="Control", stimuli=("every 1 ms",)),)),
        mapping=Mapping(tasks=(TaskAllocation(task="Control", scheduler="S", **allocation),)),
        constraints=Constraints(requirements=tuple(constraints)),
    )


def response_limit(value):
    return Requirement(name="limit", process="Control", limit=TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=value))


@pytest.mark.parametrize(
    ("model", "expected"),
    [
        (system(deadline=2 * MS), Deadline(2 * MS, is_implicit=False)),
        (system(), Deadline(MS, is_implicit=True)),
        (system([response_limit(3 * MS), response_limit(2 * MS)]), Deadline(2 * MS, is_implicit=False)),
        (system([response_limit(3 * MS)], deadline=4 * MS), Deadline(4 * MS, is_implicit=False)),
    ],
)
def test_the_deadline_is_the_stated_one_or_the_period(model, expected):
    assert deadline_of("Control", TimingContext.of(model)) == expected


def test_without_stimulus_there_is_no_deadline():
    model = System(software=Software(tasks=(Task(name="Control"),)))
    assert deadline_of("Control", TimingContext.of(model)) is None


@pytest.mark.parametrize(
    ("changes", "verdict", "reason"),
    [
        ({"deadline": 29 * US}, OK, ""),
        ({"deadline": 29 * US - 1}, MISSED, ""),
        ({"deadline": None}, None, ""),
        ({"deadline": None, "lost_activations": 2}, MISSED, "2 activations lost"),
        ({"deadline": MS, "lost_activations": 1}, MISSED, "1 activation lost"),
        ({"deadline": MS, "unfinished": 1, "longest_unfinished": Fraction(MS)}, OK, ""),
        (
            {"deadline": MS, "unfinished": 1, "longest_unfinished": Fraction(2 * MS)},
            MISSED,
            "a job had not ended 2 ms after its activation",
        ),
        ({"deadline": MS, "jobs": 0, "metrics": {}}, NOT_OBSERVED, "no job ended"),
        ({"deadline": MS, "jobs": 0, "metrics": {}, "longest_unfinished": Fraction(MS + 1)}, MISSED, None),
    ],
)
def test_the_verdict_on_a_process(changes, verdict, reason):
    found = judge_process(replace(CONTROL, verdict=None, **changes), Task(name="Control"))
    assert found.verdict is verdict
    assert reason is None or found.reason == reason


# Requirements


def verdict_on(*constraints, requirements=(), processes=(EXECUTOR, CONTROL), chains=(CHAIN,), **others):
    demanded = Constraints(constraints=constraints, requirements=requirements, **others)
    system = System(constraints=demanded)
    return list(
        judge_requirements(system, Results(processes), Results(chains), 300 * SECOND, Results([CALLBACK]), NothingObserved())
    )


class NothingObserved:
    def quantities(self, constraint):
        return ()

    def reason(self, constraint):
        return f"nothing about {constraint.name}"


def limited(limit, **changes):
    requirement = Requirement(name="R", process="Control", limit=limit)
    (found,) = verdict_on(requirements=(requirement,), processes=(replace(CONTROL, **changes),))
    return found


@pytest.mark.parametrize(
    ("limit", "changes", "verdict", "value"),
    [
        # Response times from 16 to 29 us.
        (TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=29 * US), {}, OK, 29 * US),
        (TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=28 * US), {}, MISSED, 29 * US),
        (TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=16 * US, bound=Bound.LOWER), {}, OK, 16 * US),
        (TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=17 * US, bound=Bound.LOWER), {}, MISSED, 16 * US),
        # A job that has not ended yet has taken that long at least.
        (TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=MS), {"longest_unfinished": Fraction(2 * MS)}, MISSED, 2 * MS),
        (TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=MS), {"longest_unfinished": Fraction(MS)}, OK, 29 * US),
        (TimeLimit(metric=TimeMetric.LATENESS, value=0), {}, NOT_OBSERVED, None),
        (TimeLimit(metric=TimeMetric.OS_OVERHEAD, value=0), {}, NOT_OBSERVED, None),
        (TimeLimit(metric=TimeMetric.START_TO_START, value=0), {}, NOT_OBSERVED, None),
        (TimeLimit(metric=TimeMetric.CORE_EXECUTION_TIME, value=4 * US), {}, OK, 4 * US),
        (
            TimeLimit(metric=TimeMetric.CORE_EXECUTION_TIME, value=4 * US),
            {"migrations": CountObservation(total=1, min=0, max=1)},
            NOT_OBSERVED,
            None,
        ),
        (JitterLimit(metric=TimeMetric.RESPONSE_TIME, value=13 * US), {}, OK, 13 * US),
        (JitterLimit(metric=TimeMetric.RESPONSE_TIME, value=12 * US), {}, MISSED, 13 * US),
        # A job that has not ended yet has taken 2 ms more than the shortest one already.
        (
            JitterLimit(metric=TimeMetric.RESPONSE_TIME, value=MS),
            {"longest_unfinished": Fraction(2 * MS + 16 * US)},
            MISSED,
            2 * MS,
        ),
        (JitterLimit(metric=TimeMetric.RESPONSE_TIME, value=MS), {"jobs": 1}, NOT_OBSERVED, None),
        # The period is not known.
        (JitterLimit(metric=TimeMetric.START_TO_START, value=MS), {}, NOT_OBSERVED, None),
        (JitterLimit(metric=TimeMetric.OS_OVERHEAD, value=MS), {}, NOT_OBSERVED, None),
        (CountLimit(metric=CountMetric.PREEMPTIONS, value=2), {}, OK, 2),
        (CountLimit(metric=CountMetric.PREEMPTIONS, value=1), {}, MISSED, 2),
        (CountLimit(metric=CountMetric.LOST_ACTIVATIONS, value=0), {}, OK, 0),
        (CountLimit(metric=CountMetric.LOST_ACTIVATIONS, value=0), {"lost_activations": 1}, MISSED, 1),
        # 300 jobs; a longer run can have more.
        (CountLimit(metric=CountMetric.ACTIVATIONS, value=300), {}, OK, 300),
        (CountLimit(metric=CountMetric.ACTIVATIONS, value=300), {"unfinished": 1}, MISSED, 301),
        (CountLimit(metric=CountMetric.ACTIVATIONS, value=300, bound=Bound.LOWER), {}, OK, 300),
        (CountLimit(metric=CountMetric.ACTIVATIONS, value=301, bound=Bound.LOWER), {}, NOT_OBSERVED, None),
        # On one core, jobs neither move nor start on another one.
        (CountLimit(metric=CountMetric.BOUNDED_MIGRATIONS, value=0), {}, OK, 0),
        (CountLimit(metric=CountMetric.BOUNDED_MIGRATIONS, value=0), {"core": None}, NOT_OBSERVED, None),
        (CountLimit(metric=CountMetric.CACHE_MISSES, value=5), {}, NOT_OBSERVED, None),
        (LoadLimit(metric=LoadMetric.LOAD, value=0.004), {}, OK, Fraction(4, 1000)),
        (LoadLimit(metric=LoadMetric.LOAD, value=0.003), {}, MISSED, Fraction(4, 1000)),
        (LoadLimit(metric=LoadMetric.LOAD, value=0.5, core="Other"), {}, OK, 0),
        (LoadLimit(metric=LoadMetric.LOAD, value=0.5, core="Other"), {"core": None}, NOT_OBSERVED, None),
        # 300 jobs of 4 us in 300 s.
        (LoadLimit(metric=LoadMetric.RUNNING, value=0.000004), {}, OK, Fraction(4, 10**6)),
        (LoadLimit(metric=LoadMetric.BUFFERING, value=0.1), {}, NOT_OBSERVED, None),
        (RatioLimit(metric=RatioMetric.NORMALIZED_RESPONSE_TIME, value=0.029), {}, OK, Fraction(29, 1000)),
        (RatioLimit(metric=RatioMetric.NORMALIZED_RESPONSE_TIME, value=0.028), {}, MISSED, Fraction(29, 1000)),
        (RatioLimit(metric=RatioMetric.NORMALIZED_RESPONSE_TIME, value=1), {"deadline": None}, NOT_OBSERVED, None),
        (RatioLimit(metric=RatioMetric.OS_OVERHEAD, value=1), {}, NOT_OBSERVED, None),
    ],
)
def test_the_verdict_on_a_requirement(limit, changes, verdict, value):
    found = limited(limit, **changes)
    assert (found.verdict, found.value) == (verdict, value)
    assert bool(found.reason) == (verdict is NOT_OBSERVED or value == 2 * MS)


@pytest.mark.parametrize(
    ("limited", "reason"),
    [
        ({"process": "Unknown"}, "the process that it limits is not defined, or was left out when reading"),
        ({"runnable": "unknown"}, "the runnable that it limits is not defined, or was left out when reading"),
    ],
)
def test_what_is_not_simulated_is_not_observed(limited, reason):
    limit = TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=MS)
    (found,) = verdict_on(requirements=(Requirement(name="R", limit=limit, **limited),))
    assert (found.verdict, found.reason) == (NOT_OBSERVED, reason)


# Chains: reactions from 1 to 20 ms, data ages from 1 to 39 ms


def latency(chain=CHAIN, **limits):
    return verdict_on(LatencyConstraint(name="L", chain="way", **limits), chains=(chain,))


@pytest.mark.parametrize(
    ("limits", "verdicts"),
    [
        ({"maximum": 20 * MS}, [OK]),
        ({"maximum": 20 * MS - 1}, [MISSED]),
        ({"maximum": 25 * MS, "minimum": MS}, [OK, OK]),
        ({"maximum": 25 * MS, "minimum": MS + 1}, [OK, MISSED]),
        ({"maximum": 38 * MS, "kind": LatencyKind.AGE}, [MISSED]),
        ({"maximum": 39 * MS, "kind": LatencyKind.AGE}, [OK]),
        ({}, [NOT_OBSERVED]),
    ],
)
def test_the_verdict_on_a_latency(limits, verdicts):
    assert [found.verdict for found in latency(**limits)] == verdicts


def with_route(**changes):
    return replace(CHAIN, routes=(replace(CHAIN.routes[0], **changes),))


def test_a_stimulus_without_response_misses_a_limit_that_has_passed():
    waiting = with_route(unanswered=3, longest_unanswered=Fraction(26 * MS))
    (missed,) = latency(waiting, maximum=25 * MS)
    assert (missed.verdict, missed.value, missed.reason) == (MISSED, 26 * MS, "not ended at the end of the run")
    assert [found.verdict for found in latency(waiting, maximum=30 * MS)] == [OK]
    assert [found.verdict for found in latency(waiting, maximum=40 * MS, kind=LatencyKind.AGE)] == [OK]


def test_a_chain_that_never_responds_is_missed_once_the_limit_has_passed():
    silent = replace(with_route(unanswered=3, longest_unanswered=Fraction(26 * MS)), quantities={})
    assert [found.verdict for found in latency(silent, maximum=25 * MS)] == [MISSED]
    assert [found.verdict for found in latency(silent, maximum=30 * MS)] == [NOT_OBSERVED]
    assert [found.verdict for found in latency(silent, minimum=1)] == [NOT_OBSERVED]


def test_latencies_that_are_too_long_to_be_kept_forbid_a_good_verdict():
    (found,) = latency(with_route(not_evaluated=2), maximum=25 * MS)
    assert (found.verdict, found.reason) == (NOT_OBSERVED, "2 latencies are longer than those that can be observed")
    assert [found.verdict for found in latency(with_route(not_evaluated=2), maximum=MS)] == [MISSED]


def test_the_jitter_of_a_chain():
    # From 1 to 20 ms; a stimulus without a response for 26 ms has a reaction that is longer than the least one by 25 ms at least.
    assert [found.verdict for found in latency(jitter=19 * MS)] == [OK]
    (found,) = latency(jitter=18 * MS)
    assert (found.verdict, found.value, found.quantity) == (MISSED, 19 * MS, "reaction jitter")
    (found,) = latency(with_route(longest_unanswered=Fraction(26 * MS)), jitter=20 * MS)
    assert (found.verdict, found.value) == (MISSED, 25 * MS)


def test_a_chain_that_could_not_be_followed_says_why():
    chain = ChainObservation(name="way", quantities={}, routes=(), reason="no data flow connects A and B")
    (found,) = latency(chain, maximum=25 * MS)
    assert (found.verdict, found.reason) == (NOT_OBSERVED, "no data flow connects A and B")


def test_a_chain_that_is_not_defined_is_not_observed():
    (found,) = verdict_on(LatencyConstraint(name="L", chain="unknown", maximum=1))
    assert (found.verdict, found.reason) == (NOT_OBSERVED, "the chain 'unknown' is not defined in the model")


def test_other_constraints_are_not_observed():
    found = verdict_on(DelayConstraint(name="D", source="a", target="b"), orders=(OrderConstraint(name="O", groups=()),))
    assert [(each.name, each.verdict, each.reason) for each in found] == [
        ("D", NOT_OBSERVED, "nothing about D"),
        ("O", NOT_OBSERVED, "nothing about O"),
    ]


# Runnables: response times from 2 to 9 us


@pytest.mark.parametrize(
    ("limit", "verdict", "value"),
    [
        (TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=9 * US), OK, 9 * US),
        (TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=8 * US), MISSED, 9 * US),
        (TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=3 * US, bound=Bound.LOWER), MISSED, 2 * US),
        (TimeLimit(metric=TimeMetric.WAITING_TIME, value=8 * US), NOT_OBSERVED, None),
        (TimeLimit(metric=TimeMetric.LATENESS, value=0), NOT_OBSERVED, None),
        (TimeLimit(metric=TimeMetric.ACTIVATE_TO_ACTIVATE, value=MS), NOT_OBSERVED, None),
        (CountLimit(metric=CountMetric.PREEMPTIONS, value=2), OK, 2),
        (CountLimit(metric=CountMetric.FULL_MIGRATIONS, value=0), OK, 0),
        (CountLimit(metric=CountMetric.ACTIVATIONS, value=9), NOT_OBSERVED, None),
        (LoadLimit(metric=LoadMetric.LOAD, value=0.5), NOT_OBSERVED, None),
    ],
)
def test_the_verdict_on_a_requirement_of_a_runnable(limit, verdict, value):
    (found,) = verdict_on(requirements=(Requirement(name="R", runnable="Callback", limit=limit),))
    assert (found.object, found.verdict, found.value) == ("Callback", verdict, value)
    assert bool(found.reason) == (verdict is NOT_OBSERVED)


def test_the_verdict_says_when_the_value_was_observed():
    (found,) = verdict_on(requirements=(Requirement(name="R", process="Control", limit=limit_of(28 * US)),))
    assert found.at == CONTROL.response_time.at_max.time


def limit_of(time):
    return TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=time)


def test_the_worst_route_counts_for_the_chain():
    slow = replace(CHAIN.routes[0], unanswered=2, longest_unanswered=Fraction(5 * MS), not_evaluated=1)
    chain = replace(CHAIN, quantities=latencies(1, 20, 39), routes=(*CHAIN.routes, slow))
    assert (chain.unanswered, chain.longest_unanswered, chain.not_evaluated) == (2 + 1, 5 * MS, 1)


def test_a_kept_requirement_with_the_least_margin_is_the_tightest():
    kept = limited(TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=30 * US))
    ratio = limited(RatioLimit(metric=RatioMetric.NORMALIZED_RESPONSE_TIME, value=1))
    simulation = replace(SIMULATION, requirements=Results([ratio, kept]))
    assert simulation.tightest is kept
    assert simulation.missed == ()


def test_all_metrics_of_jobs_have_a_verdict():
    for metric in TimeMetric:
        found = limited(TimeLimit(metric=metric, value=MS))
        assert (found.verdict is OK) == (found.value is not None), metric
    assert JobMetric.RESPONSE_TIME in CONTROL.metrics
