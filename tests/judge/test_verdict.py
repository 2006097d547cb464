"""Verdicts on limits by what is proved or observed; and that nothing else decides them."""

import ast
from fractions import Fraction

import pytest
from support import ROOT

from amalthea_uros.judge.evidence import Ends, ObservedProcess, ObservedValues, ProcessEvidence, ProvedLoss
from amalthea_uros.judge.limits import SystemLimit, deadline_limit, limits_of
from amalthea_uros.judge.verdict import observe, observe_process, prove, prove_process
from amalthea_uros.perf.constraints import LatencyConstraint, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.software import Task

TASK = Task(name="T")


def limit(value, *, is_upper=True, **others):
    return SystemLimit(name="L", object="T", quantity="response time", limit=value, item=TASK, is_upper=is_upper, **others)


MOST, LEAST = limit(10), limit(10, is_upper=False)


# Proofs


@pytest.mark.parametrize(
    ("ends", "verdict"),
    [
        (Ends.exactly(10), "met"),
        (Ends.exactly(11), "missed"),
        (Ends(5, 10), "met"),
        (Ends(5, 11), "unknown"),
        (Ends(11, 20), "missed"),
        (Ends(None, 11), "unknown"),
        (Ends(11, None), "missed"),
        (Ends(5, None), "unknown"),
        (Ends(5, None, is_infinite=True), "missed"),
        (Ends(), "unknown"),
    ],
)
def test_a_maximum(ends, verdict):
    assert prove(MOST, ends).verdict == verdict


@pytest.mark.parametrize(
    ("ends", "verdict"),
    [
        (Ends.exactly(10), "met"),
        (Ends.exactly(9), "missed"),
        (Ends(10, 20), "met"),
        (Ends(9, 20), "unknown"),
        (Ends(5, 9), "missed"),
        (Ends(None, 9), "missed"),
        (Ends(9, None), "unknown"),
        # In an overload, the minimum is as it is.
        (Ends(10, None, is_infinite=True), "unknown"),
    ],
)
def test_a_minimum(ends, verdict):
    assert prove(LEAST, ends).verdict == verdict


@pytest.mark.parametrize("ends", [Ends(8, 5), Ends(-1, 5), Ends(None, -3), Ends(-1, None)])
@pytest.mark.parametrize("stated", [MOST, LEAST, limit(-2), limit(0, is_upper=False)])
def test_nothing_follows_from_ends_that_contradict_each_other(ends, stated):
    found = prove(stated, ends)
    assert (found.verdict, found.ends) == ("unknown", Ends())
    assert "was computed as" in found.reason


def test_a_difference_can_be_negative():
    assert prove(limit(0, is_signed=True), Ends.exactly(-3)).verdict == "met"


def test_a_reason_is_given_where_the_decisive_end_is_missing():
    assert prove(MOST, Ends(5, None), "no bound").reason == "no bound"
    assert prove(MOST, Ends(5, 11), "no bound").reason == "the maximum is between 5 ps and 11 ps"
    assert prove(MOST, Ends(5, 10), "no bound").reason == ""


# Processes


DEADLINE = deadline_limit(TASK, 10)


@pytest.mark.parametrize(
    ("evidence", "verdict", "failure"),
    [
        ({"response": Ends(5, 10)}, "met", None),
        ({"response": Ends.exactly(11)}, "missed", "missed"),
        ({"response": Ends(5, 11)}, "unknown", None),
        # What is certainly wrong comes before what is unknown, and that before the deadline.
        ({"overload": "too much", "gap": "?"}, "unbounded", "overload"),
        ({"loss": ProvedLoss("lost", is_certain=True), "gap": "?"}, "missed", "lost"),
        ({"response": Ends(5, 10), "gap": "?"}, "unknown", None),
        ({"response": Ends(5, 10), "loss": ProvedLoss("perhaps", is_certain=False)}, "unknown", None),
        ({"response": Ends.exactly(11), "loss": ProvedLoss("perhaps", is_certain=False)}, "missed", "missed"),
    ],
)
def test_a_process(evidence, verdict, failure):
    found = prove_process(DEADLINE, ProcessEvidence(**evidence))
    assert (found.verdict, found.failure) == (verdict, failure)


def test_a_process_without_a_deadline():
    assert prove_process(None, ProcessEvidence(response=Ends(5, 10))) is None
    assert prove_process(None, ProcessEvidence(loss=ProvedLoss("perhaps", is_certain=False))).verdict == "unknown"
    # If all its callbacks are called in time, there is something that is met.
    assert prove_process(None, ProcessEvidence(is_served=True)).verdict == "met"


# Observations


def seen(low, high, **others):
    return ObservedValues(low=Fraction(low), high=Fraction(high), **others)


@pytest.mark.parametrize(
    ("stated", "values", "verdict", "value"),
    [
        (MOST, seen(5, 10), "observed_ok", 10),
        (MOST, seen(5, 11), "observed_missed", 11),
        (LEAST, seen(10, 20), "observed_ok", 10),
        (LEAST, seen(9, 20), "observed_missed", 9),
        (MOST, ObservedValues(reason="nothing"), "not_observed", None),
        # What is still pending is at least as long as it has lasted.
        (MOST, seen(5, 8, pending=Fraction(12)), "observed_missed", 12),
        (LEAST, seen(12, 15, pending=Fraction(20)), "observed_ok", 12),
        # Nothing is pending of what is below zero.
        (limit(-5, is_signed=True), seen(-9, -6), "observed_ok", -6),
        (limit(-5, is_signed=True), seen(-9, -4), "observed_missed", -4),
        # If values are missing, a limit that was kept may not have been.
        (MOST, seen(5, 10, is_complete=False, reason="some"), "not_observed", 10),
        (MOST, seen(5, 11, is_complete=False, reason="some"), "observed_missed", 11),
        # The real values can be greater: only what exceeds a maximum is certain.
        (MOST, seen(5, 11, are_least=True, reason="least"), "observed_missed", 11),
        (MOST, seen(5, 10, are_least=True, reason="least"), "not_observed", 10),
        (LEAST, seen(9, 20, are_least=True, reason="least"), "not_observed", 9),
        (MOST, seen(5, 6, violation="wrong"), "observed_missed", 6),
    ],
)
def test_observed_values(stated, values, verdict, value):
    found = observe(stated, values)
    assert (found.verdict, found.value) == (verdict, value)


def test_values_that_can_be_greater_have_no_jitter():
    assert seen(5, 9).jitter().high == 4
    assert seen(5, 9, are_least=True).jitter().high is None


@pytest.mark.parametrize(
    ("response", "lost", "verdict"),
    [(seen(5, 10), 0, "observed_ok"), (seen(5, 10), 1, "observed_missed"), (seen(5, 11), 0, "observed_missed")],
)
def test_an_observed_process(response, lost, verdict):
    assert observe_process(DEADLINE, ObservedProcess(response=response, lost_activations=lost)).verdict == verdict


# Limits


def test_a_constraint_has_a_limit_for_each_number_that_it_states():
    stated = LatencyConstraint(name="C", chain="way", minimum=1, maximum=5, jitter=3)
    assert [(each.quantity, each.limit, each.is_upper) for each in limits_of(stated)] == [
        ("reaction", 5, True),
        ("reaction", 1, False),
        ("reaction jitter", 3, True),
    ]
    assert limits_of(LatencyConstraint(name="C", chain="way")) == ()


def test_a_requirement_is_one_limit():
    requirement = Requirement(name="R", process="T", limit=TimeLimit(metric=TimeMetric.LATENESS, value=-5))
    (found,) = limits_of(requirement)
    assert (found.object, found.quantity, found.limit, found.is_signed) == ("T", "lateness", -5, True)


# One place


def test_verdicts_are_decided_in_one_room():
    deciding = [
        f"{path.relative_to(ROOT)}:{node.lineno}"
        for path in (ROOT / "amalthea_uros").rglob("*.py")
        if path.parent.name != "judge"
        if "Verdict" in (text := path.read_text())
        for node in decisions(ast.parse(text))
    ]
    assert deciding == []


def decisions(tree):
    """Where a member of a verdict is a value, and neither compared, looked up, nor in a table at the top of a module."""
    read = [node for node in ast.walk(tree) if isinstance(node, ast.Compare) or is_look_up(node)]
    read += [node.iter for node in ast.walk(tree) if isinstance(node, ast.comprehension)]
    read += [node for node in tree.body if isinstance(node, ast.Assign | ast.AnnAssign)]
    harmless = {id(part) for node in read for part in ast.walk(node)}
    for node in ast.walk(tree):
        is_member = isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and is_verdict(node.value.id)
        is_made = isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and is_verdict(node.func.id)
        if (is_member or is_made) and id(node) not in harmless:
            yield node


def is_look_up(node):
    """Whether a call counts or names what has a verdict."""
    return isinstance(node, ast.Call) and ast.unparse(node.func).endswith(("judged_in", "_with_verdict"))


def is_verdict(name):
    return name in ("Verdict", "ObservedVerdict")
