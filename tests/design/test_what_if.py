"""What a change would do: the results before and after it, as two analyses would give them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.analyze.impact import Effect, ResultPart, figures
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import apply
from amalthea_uros.design.changes.change import Change, parse_change
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.services.subject import open_system
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.uros.described import describe_file

ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"
MODEL = ROOT / "samples" / "executor.amxmi"
SYSTEM = open_system([MODEL]).system
US, MS = 10**6, 10**9


def test_all_forms_of_changes_and_subjects_mean_the_same():
    changes = {"Executor_Task.period": "2ms", "Executor_Task.priority": 0}
    text = ["Executor_Task.period=2ms", Change("Executor_Task", "priority", "0")]
    expected = amuros.what_if(MODEL, changes).impact
    assert expected
    for subject in (str(MODEL), [MODEL], iter([MODEL]), amuros.load(MODEL), SYSTEM):
        assert amuros.what_if(subject, iter(text)).impact == expected


def test_a_lower_priority_is_worse_for_one_and_better_for_the_others():
    # 12 us of the executor, 4 us of the control function: without the executor before it, it ends after 4 us, and the executor,
    # which was first, after both.
    found = amuros.what_if(MODEL, {"Executor_Task.priority": 0}).impact
    responses = {
        row.object: (row.before.value, row.after.value, row.effect)
        for row in found.rows
        if row.part is ResultPart.PROCESS and row.quantity == "worst_case_response_time"
    }
    assert responses["Control_Function"] == (16 * US, 4 * US, Effect.BETTER)
    assert responses["Executor_Task"] == (12 * US, 18 * US, Effect.WORSE)


#: Changes of the sample of which each is possible.
CHANGES = st.lists(
    st.sampled_from(
        (
            "Executor_Task.period=2ms",
            "Executor_Task.priority=0",
            "Control_Function.execution_time=9us",
            "Control_Function.preemption=cooperative",
            "Core_0.frequency=3MHz",
            "Core_0.frequency=2kHz",
            "Message_Factor.deadline=1ms",
            "Message_Factor.offset=3ms",
        )
    ),
    max_size=3,
).map(lambda texts: [parse_change(text) for text in texts])


@given(CHANGES)
def test_the_rows_are_the_differences_of_two_separate_analyses(changes):
    found = amuros.what_if(SYSTEM, changes)
    before, after = analyze_system(SYSTEM), analyze_system(*apply(SYSTEM, Settings(), changes))
    old, new = ({figure.key: figure for figure in figures(analysis)} for analysis in (before, after))
    different = {key for key in old | new if key not in old or key not in new or old[key].compared != new[key].compared}
    assert {row.figure.key for row in found.impact.rows} == different
    assert found.impact.unchanged == len((old | new).keys() - different)
    assert all(row.before == old.get(row.figure.key) and row.after == new.get(row.figure.key) for row in found.impact.rows)


@given(st.sampled_from(["1ms", "2ms", "7ms", "20ms"]), st.integers(0, 5))
def test_a_change_and_its_inverse_have_no_impact(period, priority):
    there = amuros.what_if(SYSTEM, {"Executor_Task.period": period, "Executor_Task.priority": priority})
    values = {f"{each.object}.{each.key}": each.before for each in there.differences if not each.is_consequence}
    back = amuros.what_if(there.system, values, there.settings)
    assert list(figures(back.after)) == list(figures(there.before))
    assert not amuros.what_if(SYSTEM, values).impact


def test_an_overload_is_worse_and_nothing_unknown_is_left_out():
    found = amuros.what_if(MODEL, ["Core_0.frequency=1kHz"])
    rows = {(row.object, row.quantity): row for row in found.impact.rows}
    assert (rows["", "schedulable"].before.value, rows["", "schedulable"].after.value) == ("yes", "no")
    chain = rows["factor_to_output", "max_reduced_reaction_time"]
    assert (chain.after.value, chain.effect) == (None, Effect.WORSE)
    assert "unbounded" in chain.after.reason
    assert all(row.effect is Effect.WORSE for row in found.impact.rows)


def test_what_else_changes_is_listed_as_a_consequence():
    # Of the periods 1, 10, 20 and 100 ms, 10 ms is the longest one that keeps up with messages every 10 ms.
    found = amuros.what_if(ADVANCED, ["Message_Factor.rate=100Hz"])
    assert [str(each) for each in found.differences] == [
        "Message_Factor.rate: 50 Hz -> 100 Hz",
        "Message_Factor.period: 20 ms -> 10 ms (consequence)",
    ]


def test_what_else_changes_in_a_model_is_listed_as_a_consequence():
    # The executor takes the message in every 20th of its jobs.
    system = describe_file(ADVANCED).assembly.system
    found = amuros.what_if(system, ["Executor_Task.period=2ms"], amuros.Settings(phases={"Message_Factor": 0}))
    assert [str(each) for each in found.differences] == [
        "Executor_Task.period: 1 ms -> 2 ms",
        "Message_Factor.arrival_period: 20 ms -> 40 ms (consequence)",
    ]


def test_texts_for_people():
    found = amuros.what_if(MODEL, ["Control_Function.execution_time=5us"])
    assert repr(found).startswith("<WhatIf Control_Function.execution_time: 4 us -> 5 us: schedulable yes -> yes; ")
    lines = str(found).splitlines()
    assert lines[0] == "Control_Function.execution_time: 4 us -> 5 us"
    assert lines[2] == "Before and after the change"
    assert lines[3].split() == ["object", "quantity", "before", "after", "effect", "claim"]
    assert "Control_Function  worst response" in str(found)
    assert lines[-1].endswith("other figures are unchanged")
    assert "  nothing changed: " in str(amuros.what_if(MODEL, []))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"Executor_Tsk.period": "2ms"}, "unknown object 'Executor_Tsk'; did you mean 'Executor_Task'"),
        ({"Executor_Task.perod": "2ms"}, "has no 'perod'; did you mean 'period'?"),
        ({"Executor_Task.period": "2"}, "unit"),
        ({"Executor_Task": "2ms"}, "does not name an object and a key"),
        (["Executor_Task.period"], "is not of the form OBJECT.KEY=VALUE"),
    ],
)
def test_wrong_changes_are_refused_with_advice(changes, message):
    with pytest.raises(InvalidArgumentError) as refused:
        amuros.what_if(MODEL, changes)
    assert message in str(refused.value)


def test_a_platform_that_has_changed_is_read_again(tmp_path):
    platform, path = tmp_path / "board.yaml", tmp_path / "app.yaml"
    path.write_text(
        "amuros: 1\nname: app\nhardware: {platform: ./board.yaml}\n"
        "tasks: [{name: T, period: 10 ms, execution_time: 1 ms, priority: 1}]\n"
    )
    clocks = []
    for clock in ("100 MHz", "200 MHz"):
        platform.write_text(f"amuros: 1\nplatform: board\nhardware: {{cores: 1, frequency: {clock}}}\n")
        (core,) = amuros.what_if(path, ["T.period=20ms"]).system.cores.values()
        clocks.append(amuros.what_if(path, ["T.period=20ms"]).system.frequency_of(core.clock))
    assert clocks == [100 * 10**6, 200 * 10**6]
