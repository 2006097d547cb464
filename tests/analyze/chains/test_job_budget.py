"""The job chains of a system share one limit of jobs; chains beyond it get bounds, and the result says so."""

from test_chain_systems import END, START, at, read, system, ticks, write

from amalthea_uros import analyze_system
from amalthea_uros.analyze.chains import evaluator, job_chains
from amalthea_uros.analyze.sensitivity import max_growth
from amalthea_uros.timing.response import Claim

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
