"""Phases that make no difference are not evaluated: the results are those of an analysis of every single combination."""

from dataclasses import replace
from math import gcd

import pytest
from effort import examples
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT
from test_chain_systems import END, START, at, read, system, ticks, write

from amalthea_uros import analyze_system, describe
from amalthea_uros.analyze import system as analyses
from amalthea_uros.analyze.chains import evaluator, job_chains
from amalthea_uros.analyze.chains.job_chains import JobBudget
from amalthea_uros.analyze.phases.cases import PhaseCases, least_rotation
from amalthea_uros.analyze.response_times.propagation import solve
from amalthea_uros.analyze.sensitivity import max_growth
from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.constraints import Bound, Constraints, LatencyConstraint, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.events import EventChain
from amalthea_uros.perf.software import Runnable
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.activation.releases import unknown_phases, with_phases
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import MICROSECOND as US

PRESCALERS = st.sampled_from([2, 2, 3, 4, 6])


def cases_of(built) -> PhaseCases:
    cases = PhaseCases.of(solve(TimingContext.of(built)), unknown_phases(built))
    assert cases is not None
    return cases


@st.composite
def systems(draw):
    """Calls with counters in tasks on two cores; most jobs end in the slot of 10 in which they are released."""
    tasks, runnables, combinations = [], [], 1
    for number in range(draw(st.integers(1, 3))):
        name = f"T{number}"
        body = [ticks(draw(st.integers(1, 2)))]
        if draw(st.booleans()):
            body.append(read("L"))
        for index in range(draw(st.integers(0, 2))):
            runnable = f"{name}_{index}"
            prescaler = draw(PRESCALERS)
            is_unknown = combinations * prescaler <= 12 and draw(st.sampled_from([True, True, False]))
            combinations *= prescaler if is_unknown else 1
            least = draw(st.integers(0, 3))
            inner = [ticks(least + draw(st.sampled_from([0, 0, 1])), least)]
            if draw(st.booleans()):
                inner.append(draw(st.sampled_from([read, write]))("L"))
            runnables.append(Runnable(name=runnable, activities=tuple(inner), callback=draw(st.booleans())))
            counter = Counter(
                prescaler=prescaler,
                offset=0 if is_unknown else draw(st.integers(0, prescaler + 1)),
                source=f"S{number}{index}" if is_unknown else "",
                is_phase_known=not is_unknown,
            )
            body.append(Call(runnable=runnable, counter=counter))
        if draw(st.booleans()):
            body.append(write("L"))
        period = draw(st.sampled_from([10, 10, 20, 30, 15]))
        offset = draw(st.sampled_from([0, 0, 3, 10, 12, 40]))
        tasks.append((name, period, body, draw(st.sampled_from(["one", "one", "two"])), offset))
    first, last = draw(st.sampled_from(tasks))[0], draw(st.sampled_from(tasks))[0]
    events = [at(first, START), at(last, END)]
    if len({event.name for event in events}) < 2 or first == last:
        events = [at(first, START), at(first, END)]
    chains = (EventChain(name="chain", stimulus=events[0].name, response=events[1].name),)
    built = system(tasks, events, chains=chains, runnables=runnables, cores=("one", "two"))
    limit = TimeLimit(metric=TimeMetric.RESPONSE_TIME, bound=Bound.UPPER, value=draw(st.integers(2, 12)) * US)
    constraints = Constraints(
        requirements=(Requirement(name="R", process=first, limit=limit),),
        constraints=(LatencyConstraint(name="L", chain="chain", maximum=draw(st.integers(5, 60)) * US),),
    )
    return replace(built, constraints=constraints)


def everything(analysis):
    """The results, and which combination is the worst one for each process."""
    worst = {name: solution.context.system for name, solution in analysis.worst_solutions.items()}
    return {name: getattr(analysis, name) for name in ("processors", "processes", "callbacks", "chains", "requirements")} | {
        "summary": analysis.summary,
        "assumptions": analysis.assumptions,
        "findings": analysis.findings,
        "worst": worst,
    }


@examples(10)
@given(systems())
def test_the_results_are_those_of_all_combinations(built):
    found = everything(analyze_system(built))
    with pytest.MonkeyPatch.context() as patch:
        for method in ("_of_process", "of_chain"):
            patch.setattr(PhaseCases, method, lambda cases, _: cases._single)
        assert found == everything(analyze_system(built))


@examples(10)
@given(systems())
def test_combinations_share_only_what_each_of_them_finds_alone(built):
    cases = PhaseCases.of(solve(TimingContext.of(built)), unknown_phases(built))
    for number, found in cases.solutions(cases._single) if cases else ():
        alone = solve(TimingContext.of(with_phases(built, cases.combinations[number])))
        assert (found.responses, found.reasons, found.event_models) == (alone.responses, alone.reasons, alone.event_models)
        assert (found.context.scheduled, found.context.demands) == (alone.context.scheduled, alone.context.demands)
        for name in alone.context.system.processes:
            assert found.context.dataflow.events.positions(name) == alone.context.dataflow.events.positions(name)
            assert found.context.dataflow.firings(name) == alone.context.dataflow.firings(name)


def test_few_combinations_of_the_sample_are_evaluated(monkeypatch):
    evaluated = []
    analysis = analyses._analysis
    monkeypatch.setattr(analyses, "_analysis", lambda *arguments: evaluated.append(1) or analysis(*arguments))
    found = analyze_system(describe(ROOT / "samples" / "rclc-in-executor.yaml").system)
    # 10 * 2 * 50 phases repeat every 50 jobs, so that 20 are different.
    # For the timer in its own task only matters which of the three calls are in the job of the executor with which it is released.
    cases = cases_of(describe(ROOT / "samples" / "rclc-in-executor.yaml").system)
    assert sorted(map(len, cases.of_processes.values())) == [8, 20]
    assert list(map(len, cases.of_chains)) == [20]
    assert len(evaluated) <= 8 + 20 + 20
    assert "over all 1,000 phases" in found["rclc_executor"].response.method


def counted(prescaler, source):
    return Counter(prescaler=prescaler, source=source, is_phase_known=False)


def one_task(*prescalers, work=1, period=10, **more):
    calls = [Call(runnable=f"r{n}", counter=counted(each, f"s{n}")) for n, each in enumerate(prescalers)]
    runnables = [Runnable(name=f"r{number}", activities=(ticks(work),)) for number in range(len(prescalers))]
    return system([("T", period, [ticks(1), *calls], *more.values())], [at("T", START), at("T", END)], runnables=runnables)


@pytest.mark.parametrize(("one", "other"), [(2, 3), (4, 6), (5, 5)])
def test_phases_of_one_task_are_the_same_if_they_have_the_same_distance(one, other):
    """Two rows of jobs are equal after a shift if the differences of their phases are equal modulo what both have in common."""
    (cases,) = cases_of(one_task(one, other)).of_processes.values()
    assert len(cases) == gcd(one, other)
    assert set(cases.values()) == {one * other // gcd(one, other)}


def test_only_the_distance_of_the_phases_of_two_tasks_counts_for_a_chain_through_both():
    runnables = [Runnable(name=f"r{n}", activities=(ticks(1), access("L"))) for n, access in enumerate((write, read))]
    tasks = [(f"T{n}", 10, [Call(runnable=f"r{n}", counter=counted(20, f"s{n}"))]) for n in range(2)]
    (cases,) = cases_of(system(tasks, [at("T0", START), at("T1", END)], runnables=runnables)).of_chains
    assert len(cases) == 20
    assert sum(cases.values()) == 20 * 20


@pytest.mark.parametrize("more", [{"core": "core", "offset": 10}, {"core": "core", "offset": 4}])
def test_each_combination_counts_if_the_first_jobs_are_others(more):
    # With an offset of a period the first job is not released in the first cycle; with 4 jobs of 7 do not end in slots of 10.
    (cases,) = cases_of(one_task(2, 3, work=3, **more)).of_processes.values()
    assert len(cases) == 6


def test_each_combination_counts_if_jobs_end_after_the_next_release():
    (cases,) = cases_of(one_task(2, 3, work=5)).of_processes.values()
    assert len(cases) == 6


@given(st.lists(st.integers(0, 2), min_size=1, max_size=12))
def test_the_least_rotation(row):
    start = least_rotation(row)
    assert row[start:] + row[:start] == min(row[at:] + row[:at] for at in range(len(row)))


def test_phases_without_job_chains_are_an_assumption(monkeypatch):
    built = one_task(2, 3, work=5)
    (exact,) = analyze_system(built).chains
    assert {value.claim for value in exact.values} == {Claim.EXACT}
    needed = []
    count = job_chains.job_count
    monkeypatch.setattr(job_chains, "job_count", lambda *chain: needed.append(count(*chain)) or needed[-1])
    analyze_system(built)
    # Enough for each of the phases, but not for all of them.
    monkeypatch.setattr(analyses, "JobBudget", lambda: JobBudget(jobs=sum(needed) - 1))
    found = analyze_system(built)
    assert Claim.EXACT not in {value.claim for value in found.chains[0].values}
    assert any(job_chains.TOO_MANY_JOBS in assumption for assumption in found.assumptions)


# The job chains of a system share one limit of jobs; chains beyond it get bounds, and the result says so.


TASKS = [("A", 7, [ticks(1), write("L")]), ("B", 11, [read("L"), ticks(1)])]
EVENTS = [at("A", START), at("B", END)]


def test_without_job_chains_there_are_safe_bounds(monkeypatch):
    exact = analyze_system(system(TASKS, EVENTS))
    monkeypatch.setattr(job_chains, "job_count", lambda *_: job_chains.MAX_JOBS + 1)
    bounded = analyze_system(system(TASKS, EVENTS))
    (before,), (after,) = exact.chains, bounded.chains
    times = {value.quantity: value.value for value in before.values}
    assert {value.claim for value in before.values} == {Claim.EXACT}
    assert after.values
    for value in after.values:
        assert value.claim is Claim.BOUND
        assert value.value >= times[value.quantity] if value.quantity.is_upper else value.value <= times[value.quantity]
    assert after.why.startswith("bounds: the job chains of all chains together")
    assert any("job chains of all chains together" in sentence for sentence in bounded.assumptions)
    assert not any("job chains of all chains together" in sentence for sentence in exact.assumptions)


def test_the_sensitivity_evaluates_no_chains_of_which_nothing_is_demanded(monkeypatch):
    analysis = analyze_system(system(TASKS, EVENTS))
    evaluated = []
    monkeypatch.setattr(evaluator.ChainEvaluator, "chain", lambda _, chain: evaluated.append(chain.name))
    # With a factor of 3, B ends 6 us after its release, before A is released again.
    assert max_growth(analysis) >= 3
    assert not evaluated
