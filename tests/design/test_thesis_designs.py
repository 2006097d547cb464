"""Designs of the thesis's application, and of others like it, against those that a schedule played out gives.

design.json: each row has the worst and best time from the job that takes the message to the output, over all phases of the message, and
the least upper bound from the arrival of the message, which may come just after a release of the executor.
"""

import json
from fractions import Fraction

import pytest
from effort import every
from support import ROOT, SHARED

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.optimize.problem import Conclusion
from amalthea_uros.design.optimize.quantities import FROM_ARRIVAL
from amalthea_uros.services.optimize import Optimization, optimize, plan_optimization
from amalthea_uros.units import MICROSECOND as US


def changes_of(row: dict) -> tuple[Change, ...]:
    """The changes of a row."""
    found = []
    for key, value in row["change"].items():
        if key == "priority_order":
            found += [Change(task, "priority", str(number)) for task, number in zip(value, (3, 2, 1), strict=True)]
        else:
            found.append(Change(*key.rsplit(".", 1), f"{value}us"))
    return tuple(found)


def application(problem: dict) -> str:
    """The description of a problem."""
    executor, subscription, timer = problem["executor"], problem["subscription"], problem["timer"]
    longest_execution = max(executor["with_message"], subscription["execution_time"], timer["execution_time"])
    shortest = min(period for period in problem["periods_on_offer"] if period > longest_execution)
    return f"""
amuros: 1
name: periods
hardware: single-core
middleware:
  executor:
    name: Executor_Task
    period: {shortest} us
    priority: 3
    execution_time: {{base: {executor["base"]} us, per_message: {executor["with_message"] - executor["base"]} us}}
application:
  nodes:
    - name: node
      timers:
        - name: Control_Function
          period: {shortest} us
          priority: 2
          execution_time: {timer["execution_time"]} us
          reads: [b]
          writes: [c]
      subscriptions:
        - name: Message_Factor
          topic: factor
          rate: {Fraction(10**6, problem["message_interval"])} Hz
          message_size: 4 B
          task_period: {shortest} us
          priority: 1
          buffer: a
          execution_time: {subscription["execution_time"]} us
          writes: [b]
chains:
  - {{name: chain, path: [Executor_Task, Message_Factor, Control_Function], reaction: {problem["chain_limit"]} us}}
"""


def choose_periods(problem: dict) -> Optimization:
    """Judge all periods on offer."""
    offers = ",".join(f"{period}us" for period in problem["periods_on_offer"])
    tasks = ("Executor_Task", "Message_Factor", "Control_Function")
    return optimize(
        application(problem),
        vary=(),
        offers=[f"{task}.period={offers}" for task in tasks],
        goals=["load", "chain.max_reduced_reaction_time"],
        is_rate_monotonic=True,
        may_be_later=True,
        proposals=0,
    )


SAMPLE = ROOT / "samples" / "bodas-test-advanced.yaml"
CHAIN = "factor-to-output"
REACTION = f"{CHAIN}.max_reduced_reaction_time"
_FILE = SHARED / "vectors" / "design.json"
DESIGN = json.loads(_FILE.read_text()) if _FILE.exists() else {}
ROWS = [row for problem in DESIGN.get("thesis", ()) for row in problem["rows"]]


@pytest.fixture(scope="module", name="plan")
def fixture_plan():
    return plan_optimization(SAMPLE, may_be_later=True)


@pytest.mark.parametrize("row", every(6, ROWS), ids=lambda row: str(row["change"]))
def test_each_single_change_has_the_figures_of_the_schedule(row, plan):
    designs, figures = plan.evaluator.designs, plan.evaluator.scale.figures
    analysis = analyze_system(*designs.configure(changes_of(row)))
    reaction = figures.range(analysis, CHAIN, "max_reduced_reaction_time")
    shortest = figures.range(analysis, CHAIN, "min_first_to_first")
    arrival = figures.range(analysis, CHAIN, FROM_ARRIVAL)
    # A message waits for a release, not for a multiple of the period: the rows with offsets of the executor count them twice.
    offset = row["change"].get("Executor_Task.offset", 0)
    assert (reaction.upper, reaction.lower) == (row["worst"] * US,) * 2
    assert shortest.lower == row["best"] * US
    assert arrival.upper == (row["from_arrival_worst_open"] - offset) * US
    if row["change"].get("priority_order", ["Executor_Task"])[0] == "Executor_Task":
        assert arrival.is_exact
    bound = plan.evaluator.chains[CHAIN].shortest_maximum(analysis.solution.context.system)
    assert bound is not None
    assert bound <= row["worst"] * US
    evaluation = plan.evaluator.judged((), analysis)
    assert evaluation.feasible == ("yes" if row["schedulable"] and row["worst"] <= 25_000 else "no")


SINGLE = (
    "Executor_Task.period=500us,1ms,2ms,5ms,10ms,20ms",
    "Message_Factor.period=1ms,2ms,5ms,10ms,20ms",
    "Control_Function.period=1ms,2ms,5ms,10ms,20ms",
    "Message_Factor.offset=0ms..19ms/1ms",
    "Control_Function.offset=0us,100us,200us,500us,900us",
    "Executor_Task.offset=0us,100us,200us,500us,900us",
)


@pytest.mark.parametrize(("limit", "periods"), every(2, [("11ms", {"1 ms", "10 ms"}), ("5ms", {"1 ms"})]))
def test_one_change_brings_the_latency_below_a_limit(limit, periods):
    found = optimize(SAMPLE, offers=SINGLE, limits=[f"{REACTION}<{limit}"])
    # The description allows tasks of 1, 10, 20 and 100 ms.
    # An executor every 20 ms would have 1.004 ms from the job that takes the message, but 21.004 ms from its arrival.
    assert {(each.target, each.after) for proposal in found.proposals for each in proposal.differences} == {
        ("Message_Factor.period", period) for period in periods
    }
    # Tasks of 2 and 5 ms, which the description cannot state, are no part of the space.
    assert (found.search.conclusion, found.search.ended) == (Conclusion.OPTIMAL, "")
    assert found.search.broken["the description cannot state it"] > 0
    assert all(proposal.evaluation.is_exact for proposal in found.proposals)
    assert found[0].differences[0].after == "1 ms"


def test_a_slower_executor_is_not_proposed_even_where_a_later_answer_is_allowed():
    found = optimize(SAMPLE, offers=SINGLE[:1], vary=(), limits=[f"{REACTION}<11ms"], may_be_later=True)
    assert not found.proposals
    assert found.search.conclusion is Conclusion.NONE
    assert found.search.broken == {"Executor_Task runs less often than the fastest callback": 4}


#: Those in which not too many phases have to be analysed; the others have been solved to their optimum as well.
PROBLEMS = [problem for problem in DESIGN.get("period_problems", ()) if problem["id"][-2:] not in ("03", "09", "11")]


@pytest.mark.parametrize("problem", every(9, PROBLEMS), ids=lambda problem: problem["id"])
def test_periods_on_offer_are_chosen_as_by_trying_all(problem):
    found = choose_periods(problem)
    assert found.space.size == len(problem["periods_on_offer"]) ** 3
    assert len(found.search.best) == len(problem["feasible"])
    assert sum(found.search.broken.values()) <= len(problem["excluded"])
    if not problem["feasible"]:
        assert found.search.conclusion is Conclusion.NONE
        return
    assert found.search.conclusion is Conclusion.OPTIMAL
    assert found.search.best[0].values[0] == Fraction(problem["least_load"])
    assert min(each.values[1] for each in found.search.best) == problem["least_latency"] * US
