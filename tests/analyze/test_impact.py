"""What a change does to the results: only what is guaranteed counts, and unknown is never better."""

from fractions import Fraction

import pytest
from effort import examples
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT
from system_strategies import systems

from amalthea_uros.analyze.impact import (
    ComparedFigure,
    Effect,
    FigureUnit,
    Impact,
    Preference,
    ResultPart,
    _of_requirement,
    compare,
    impact,
    verdict_figure,
)
from amalthea_uros.analyze.results.processes import RequirementResult
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import apply
from amalthea_uros.design.changes.change import parse_change
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.judge.verdict import Failure, Verdict
from amalthea_uros.services.subject import open_system
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.response import Claim

GOOD = (Verdict.MET, Schedulable.YES)
OPEN = (Verdict.UNKNOWN, Schedulable.UNKNOWN, None)
BAD = (Verdict.MISSED, Verdict.UNBOUNDED, Failure.LOST, Failure.OVERLOAD, Schedulable.NO)


def figure(value, goal=Preference.LOW, **others):
    return ComparedFigure(part=ResultPart.PROCESS, object="A", quantity="q", value=value, goal=goal, **others)


OVERLOAD = figure(None, is_overload=True)
LESS, MORE = (figure(None, unit=FigureUnit.SHARE, at_least=Fraction(part, 4)) for part in (1, 2))


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        # The goal says which values are better.
        (figure(1), figure(2), Effect.WORSE),
        (figure(1, Preference.HIGH), figure(2, Preference.HIGH), Effect.BETTER),
        (figure(1, Preference.NONE), figure(2, Preference.NONE), Effect.CHANGED),
        # A value that becomes unknown is worse, but nobody can say whether a value is better than an unknown one.
        *((figure(1, goal), figure(None, goal), Effect.WORSE) for goal in Preference),
        (figure(None), figure(1), Effect.UNKNOWN),
        # Any value is better than an overload, and an overload is worse than unknown.
        (OVERLOAD, figure(10**15), Effect.BETTER),
        (figure(None), OVERLOAD, Effect.WORSE),
        (OVERLOAD, figure(None), Effect.UNKNOWN),
        # A known part of an unknown load is compared, too.
        (LESS, MORE, Effect.UNKNOWN),
    ],
)
def test_the_effect_of_a_figure_that_changes(before, after, expected):
    assert [row.effect for row in compare([before], [after]).rows] == [expected]


@pytest.mark.parametrize("before", GOOD + OPEN + BAD)
@pytest.mark.parametrize("after", GOOD + OPEN + BAD)
def test_only_what_is_met_for_certain_is_better(before, after):
    rows = compare([verdict_figure(ResultPart.PROCESS, "A", before)], [verdict_figure(ResultPart.PROCESS, "A", after)]).rows
    if before == after:
        assert rows == ()
        return
    found = rows[0].effect
    assert (found is Effect.BETTER) == (after in GOOD and before not in GOOD)
    if before in GOOD and after not in GOOD:
        assert found is Effect.WORSE
    if before in OPEN and after in BAD:
        assert found is Effect.WORSE
    if before in BAD and after in OPEN:
        assert found is Effect.UNKNOWN


def test_what_only_one_side_has_is_neither_better_nor_worse():
    one = figure(1)
    assert [row.effect for row in compare([], [one]).rows] == [Effect.ADDED]
    assert [row.effect for row in compare([one], []).rows] == [Effect.REMOVED]


def test_the_claim_of_a_row_is_the_weaker_one():
    (row,) = compare([figure(2, claim=Claim.EXACT)], [figure(3, claim=Claim.BOUND)]).rows
    assert row.claim is Claim.BOUND


def test_requirements_of_one_name_are_compared_in_their_order():
    found = compare([figure(1), figure(5)], [figure(1), figure(4)])
    assert [(row.before.value, row.after.value) for row in found.rows] == [(5, 4)]
    assert found.unchanged == 1


def requirement(limit, thing="A", verdict=Verdict.MET, value=5):
    return RequirementResult(
        name="R", object=thing, quantity="response time", is_upper=True, limit=limit, verdict=verdict, lower=value, upper=value
    )


def of_requirements(*requirements):
    """The figures of requirements."""
    return [figure for each in requirements for figure in _of_requirement(each)]


def test_a_limit_that_changes_is_said_where_its_margin_and_verdict_get_better():
    rows = compare(of_requirements(requirement(4, verdict=Verdict.MISSED)), of_requirements(requirement(9))).rows
    found = {row.quantity: (row.before.value, row.after.value, row.effect) for row in rows}
    assert found["limit"] == (4, 9, Effect.CHANGED)
    assert found["verdict"] == (Verdict.MISSED, Verdict.MET, Effect.BETTER)


def test_requirements_of_one_name_about_different_objects_are_not_compared():
    bad, good = requirement(4, "A", Verdict.MISSED), requirement(9, "B")
    assert not compare(of_requirements(bad, good), of_requirements(good, bad))
    effects = {row.effect for row in compare(of_requirements(bad), of_requirements(good)).rows}
    assert effects == {Effect.ADDED, Effect.REMOVED}


VALUES = st.one_of(st.none(), st.integers(0, 9))
SIDES = st.dictionaries(
    st.sampled_from("ABCDE"), st.builds(figure, VALUES, st.just(Preference.LOW), is_overload=st.just(False))
)
OPPOSITE = {
    Effect.BETTER: {Effect.WORSE},
    Effect.WORSE: {Effect.BETTER, Effect.UNKNOWN},
    Effect.UNKNOWN: {Effect.WORSE, Effect.UNKNOWN},
    Effect.ADDED: {Effect.REMOVED},
    Effect.REMOVED: {Effect.ADDED},
    Effect.CHANGED: {Effect.CHANGED},
}


def named(side):
    return [
        ComparedFigure(part=each.part, object=name, quantity=each.quantity, value=each.value, goal=each.goal)
        for name, each in side.items()
    ]


@given(SIDES, SIDES)
def test_the_way_back_has_the_same_rows_with_opposite_effects(one, other):
    there, back = compare(named(one), named(other)), compare(named(other), named(one))
    assert there.unchanged == back.unchanged
    effects = {row.figure.key: row.effect for row in back.rows}
    assert {row.figure.key for row in there.rows} == effects.keys()
    assert all(effects[row.figure.key] in OPPOSITE[row.effect] for row in there.rows)


@given(SIDES)
def test_no_change_has_no_impact(side):
    assert compare(named(side), named(side)) == Impact(rows=(), unchanged=len(side))


# The impact of pairs of random systems, against the results of both analyses read without the code of the impact.


#: What is certain about a process, requirement or system that is fine.
FINE = {"met", "yes"}
LATENCIES = ("max_reduced_reaction_time", "max_reduced_data_age")


def worst_times(analysis):
    """The guaranteed worst values by what they are about, None where there is none; a name that is there twice is left out."""
    found = {}
    for process in analysis.processes:
        found[ResultPart.PROCESS, process.name, "worst_case_response_time"] = (
            process.response.worst if process.response else None
        )
    for chain in analysis.chains:
        values = {value.quantity: value.value for value in reversed(chain.values)}
        found |= {(ResultPart.CHAIN, chain.name, quantity): values.get(quantity) for quantity in LATENCIES}
    return found


def verdicts(analysis):
    found = {(ResultPart.SYSTEM, "", "schedulable", ""): str(analysis.summary.schedulable)}
    for process in analysis.processes:
        found[ResultPart.PROCESS, process.name, "verdict", ""] = str(process.verdict)
    requirements = {}
    for each in analysis.requirements:
        about = f"{'maximum' if each.is_upper else 'minimum'} {each.quantity} of {each.object}"
        requirements.setdefault((ResultPart.REQUIREMENT, each.name, "verdict", about), []).append(str(each.verdict))
    return found | {key: values[0] for key, values in requirements.items() if len(values) == 1}


SAMPLE = open_system([ROOT / "samples" / "drive-and-lift.amxmi"]).system
#: From lost activations and overload to everything twice as fast.
CHANGES = {
    "Control_Speed.priority": ("0", "3", "9"),
    "Task_5ms.period": ("100us", "5ms", "20ms"),
    "Drive_Valve.execution_time": ("1us", "9ms", "30ms"),
    "Core_0.frequency": ("1MHz", "150MHz", "600MHz"),
    "Task_Log.deadline": ("10us", "1s"),
    "Set_Speed.jitter": ("0s", "40ms"),
    "Report_Odometry.core": ("Core_0", "Core_1"),
}


@st.composite
def changed_systems(draw):
    """The sample with some changes."""
    keys = draw(st.sets(st.sampled_from(sorted(CHANGES)), max_size=3))
    changes = [parse_change(f"{key}={draw(st.sampled_from(CHANGES[key]))}") for key in sorted(keys)]
    return apply(SAMPLE, Settings(), changes)


@examples(5)
@given(changed_systems(), changed_systems())
def test_pairs_of_changed_samples(one, other):
    judge(analyze_system(*one), analyze_system(*other))


@examples(6)
@given(systems(most=1), systems(most=1))
def test_pairs_of_random_systems(one, other):
    judge(analyze_system(one), analyze_system(other))


def judge(before, after):
    """Nothing that is called better is no better, and nothing that is worse is called anything else."""
    effects = {row.figure.key: row.effect for row in impact(before, after).rows}
    old, new = worst_times(before), worst_times(after)
    for key in old.keys() & new.keys():
        effect = effects.get((*key, ""))
        if old[key] is not None and (new[key] is None or new[key] > old[key]):
            assert effect is Effect.WORSE, key
        if effect is Effect.BETTER and old[key] is not None:
            assert new[key] < old[key], key
        assert not (effect is Effect.BETTER and new[key] is None), key
    old, new = verdicts(before), verdicts(after)
    for key in old.keys() & new.keys():
        assert (effects.get(key) is Effect.BETTER) == (new[key] in FINE and old[key] not in FINE), key
        if old[key] in FINE and new[key] not in FINE:
            assert effects[key] is Effect.WORSE, key
    for key in new.keys() - old.keys():
        assert effects[key] is Effect.ADDED
    for key in old.keys() - new.keys():
        assert effects[key] is Effect.REMOVED
