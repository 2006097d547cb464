"""What a report puts first, and what it says of each limit."""

from dataclasses import replace
from fractions import Fraction

import pytest
from support import ROOT

from amalthea_uros import analyze, task, taskset
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.analyze.results.processes import RequirementResult
from amalthea_uros.judge.verdict import Verdict, unknown
from amalthea_uros.report.documents.analysis import _requirements
from amalthea_uros.report.documents.judged import (
    decisive_quantity,
    judged_items,
    limit_text,
    limits_table,
    requirements_of,
    why,
)
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS

ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"


def items(changes=()):
    return {item.name: item for item in judged_items(analyze(ADVANCED, changes=changes))}


def cells(analysis, *titles):
    """Some columns of the table of limits."""
    found = limits_table(analysis)
    numbers = [[column.title for column in found.columns].index(title) for title in titles]
    return [tuple(str(row[number]) for number in numbers) for row in found.rows]


def test_what_uses_most_of_its_limit_comes_first():
    # 20.029 ms of 25 ms, 29 us of 1 ms, 25 us of 1 ms, 31 us of 20 ms: the least time left is that of the second one.
    assert list(items()) == ["factor-to-output_reaction", "Control_Function_response_time", "Executor_Task", "Message_Factor"]


def test_of_an_unknown_verdict_the_share_is_an_upper_bound():
    found = cells(analyze(ADVANCED, changes={"Control_Function.execution_time": "980us"}), "used", "verdict")
    assert [verdict for used, verdict in found if used.startswith("up to")] == ["unknown"]


def test_a_process_that_loses_activations_is_shown_beside_its_requirement():
    found = items({"Control_Function.execution_time": "980us"})
    assert found["Control_Function"].verdict is Verdict.MISSED
    assert found["Control_Function_response_time"].verdict is Verdict.UNKNOWN
    assert next(iter(found)) == "Control_Function"


@pytest.mark.parametrize("changes", [(), {"Control_Function.execution_time": "980us"}])
def test_a_response_time_has_one_claim(changes):
    analysis = analyze(ADVANCED, changes=changes)
    claims = {each.name: each.response.claim for each in analysis.processes}
    shown = dict(cells(analysis, "requirement", "claim"))
    for item in judged_items(analysis):
        if getattr(item, "quantity", "") == "response time":
            assert shown[item.name] == claims[item.object]


def test_a_value_below_a_lower_limit_falls_short_of_it():
    found = items({"Control_Function.execution_time": "5 us"})["Control_Function_response_time"]
    below = replace(found, is_upper=False, limit=20 * MS, lower=4_090 * US, upper=4_090 * US, verdict=Verdict.MISSED)
    assert why(below) == "falls short of its limit by 15.91 ms"
    above = replace(below, is_upper=True, limit=4 * MS)
    assert why(above) == "exceeds its limit by 90 us"


def test_shares_order_tasks_of_different_periods():
    # 9 ms of 10 ms are closer than 600 us of 1 ms, which has less time left.
    system = taskset(
        [task("fast", period="1 ms", wcet="600 us", core="A"), task("slow", period="10 ms", wcet="9 ms", core="B")],
        priorities="rate monotonic",
    )
    assert [item.name for item in judged_items(analyze(system))] == ["slow", "fast"]


def test_a_chain_is_not_met_if_its_jitter_is_unknown():
    # Reactions from 1.016 to 20.029 ms over all phases, which are met with a limit of 25 ms; of 15 ms of jitter, that is unknown.
    analysis = analyze(ADVANCED.read_text().replace("reaction: 25 ms", "reaction: 25 ms, jitter: 15 ms"))
    jitter, reaction = requirements_of("factor-to-output", analysis)
    assert (jitter.quantity, jitter.verdict) == ("reaction jitter", Verdict.UNKNOWN)
    assert (reaction.quantity, reaction.verdict) == ("reaction", Verdict.MET)
    assert decisive_quantity("factor-to-output", analysis) is LatencyQuantity.MAX_REDUCED_REACTION_TIME
    claims = dict(cells(analysis, "what", "claim"))
    assert claims["reaction of factor-to-output"] == "exact"
    assert claims["reaction jitter of factor-to-output"] == "bound"


def test_a_limit_that_is_no_time_is_shown_as_the_model_states_it():
    """As `simulate` shows it, whether anything proves it or not."""
    analysis = analyze(ADVANCED)
    stated = analysis.requirements[0].stated
    number = replace(stated, name="R", quantity="data age in cycles", limit=Fraction(3), is_time=False)
    result = RequirementResult.of(number, unknown("it is not known"))
    assert limit_text(result) == "≤ 3"
    (row,) = _requirements(replace(analysis, requirements=(result,))).rows
    assert row[2] == "at most 3"
