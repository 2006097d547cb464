"""A simulation as text and as JSON, from results made by hand."""

import json
from dataclasses import replace
from fractions import Fraction
from io import StringIO
from pathlib import Path

import pytest
from simulations import CHAIN, CONTROL, EXECUTOR, SIMULATION, observation

from amalthea_uros._internal.by_name import Results
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.report import formats
from amalthea_uros.report.documents.simulation import closing_line, duration_text
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.simulate.observations import CountObservation
from amalthea_uros.simulate.results import LabelObservation, ObservedVerdict, RequirementObservation, RunnableObservation
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import SECOND


def result_of(simulation, **others):
    known = {"paths": (Path("app.yaml"),), "system": None, "options": None, "findings": ()}
    return SimulationResult(simulation=simulation, **known | others)


def text(simulation, **others):
    stream = StringIO()
    formats.write("text", result_of(simulation, **others), stream)
    return stream.getvalue()


def content(simulation, **others):
    stream = StringIO()
    formats.write("json", result_of(simulation, **others), stream)
    return json.loads(stream.getvalue())


def cells(shown, first):
    """The cells of the first row that starts with a name."""
    row = next(line for line in shown.splitlines() if line.strip().startswith(f"{first}  "))
    return [cell for cell in row.strip().split("  ") if cell]


def limit(**values):
    found = {"name": "R", "object": "Control", "quantity": "response time", "is_upper": True, "limit": Fraction(28 * US)}
    return RequirementObservation(**(found | {"verdict": ObservedVerdict.MISSED, "value": Fraction(29 * US)} | values))


CALLBACK = RunnableObservation(
    name="Callback",
    executions=300,
    metrics={
        JobMetric.RESPONSE_TIME: observation(2 * US, 5 * US, 9 * US),
        JobMetric.NET_EXECUTION_TIME: observation(1 * US, 2 * US, 4 * US),
    },
    preemptions=CountObservation(total=7, min=0, max=2),
    migrations=CountObservation(total=0, min=0, max=0),
)
LABELS = (
    LabelObservation(
        name="speed", reads=1200, writes=300, unwritten_reads=4, overwritten=7, age=observation(US, 2 * US, 3 * US)
    ),
    LabelObservation(name="unread", reads=0, writes=0, unwritten_reads=0, overwritten=0),
)
WITH_PARTS = replace(SIMULATION, runnables=Results([CALLBACK]), labels=Results(LABELS))
SLOW = limit(name="slow")
UNSEEN = limit(name="unseen", verdict=ObservedVerdict.NOT_OBSERVED, value=None, reason="no job of 'Control' ended")


def with_requirements(*requirements):
    return replace(SIMULATION, requirements=Results(requirements))


# Text


def test_the_first_line_names_model_duration_seed_and_mode():
    assert text(SIMULATION).splitlines()[0] == "Simulation of app.yaml: 5 min, seed 7, mode sampled"


def test_a_row_for_each_process():
    shown = text(SIMULATION)
    assert [cell.strip() for cell in cells(shown, "Control")] == [
        *("Control", "Core", "300", "0.400%", "16 us", "16.65 us", "29 us", "1 ms", "0", "observed ok")
    ]
    assert "period 1 ms" in cells(shown, "Executor")


def test_interrupts_of_a_core_come_first():
    interrupt = replace(EXECUTOR, is_isr=True)
    shown = text(replace(SIMULATION, processes=Results([CONTROL, interrupt])))
    assert shown.index("Executor") < shown.index("Control")


def test_processes_of_a_core_are_sorted_by_priority_and_unknown_ones_come_last():
    priorities = {"Low": 1, "Unknown": None, "High": 10, "Middle": 2}
    processes = Results(replace(CONTROL, name=name, priority=priority) for name, priority in priorities.items())
    shown = text(replace(SIMULATION, processes=processes))
    assert sorted(priorities, key=shown.index) == ["High", "Middle", "Low", "Unknown"]


def test_cores_that_are_idle_are_left_out():
    shown = text(SIMULATION)
    assert "1.670%" in shown
    assert "Idle" not in shown


def test_a_process_without_jobs_has_dashes():
    silent = replace(CONTROL, jobs=0, metrics={}, core=None, deadline=None, verdict=None)
    shown = text(replace(SIMULATION, processes=Results([silent])))
    assert [cell.strip() for cell in cells(shown, "Control")] == [
        *("Control", "-", "0", "0.400%", "-", "-", "-", "-", "0", "-")
    ]


def test_metrics_are_shown_on_request_in_microseconds():
    assert "Metrics of" not in text(SIMULATION)
    shown = text(SIMULATION, with_metrics=True)
    assert "Metrics of Control (us)" in shown
    assert [cell.strip() for cell in cells(shown.split("Metrics of Control")[1], "response time")] == [
        *("response time", "16.000", "16.650", "29.000")
    ]


def test_minima_are_rounded_down_and_maxima_up():
    metrics = {JobMetric.LATENESS: observation(Fraction(-20, 3), Fraction(-1), Fraction(20, 3))}
    shown = text(replace(SIMULATION, processes=Results([replace(CONTROL, metrics=metrics)])), with_metrics=True)
    assert [cell.strip() for cell in cells(shown, "lateness")] == ["lateness", "-0.001", "-0.001", "0.001"]


def test_a_row_for_each_chain():
    assert [cell.strip() for cell in cells(text(SIMULATION), "way")] == [
        *("way", "300", "1 ms", "10.52 ms", "20 ms", "39 ms", "1")
    ]


def test_latencies_that_were_not_observed_are_mentioned():
    chain = replace(CHAIN, routes=(replace(CHAIN.routes[0], not_evaluated=1200),))
    assert "1,200 latencies too long to be observed" in text(replace(SIMULATION, chains=Results([chain])))


def test_a_row_for_each_measured_runnable_and_each_label():
    shown = text(WITH_PARTS)
    assert [cell.strip() for cell in cells(shown, "Callback")] == ["Callback", "300", "2 us", "5 us", "9 us", "4 us"]
    assert [cell.strip() for cell in cells(shown, "speed")] == ["speed", "1,200", "300", "4", "7", "1 us", "2 us", "3 us"]
    assert [cell.strip() for cell in cells(shown, "unread")] == ["unread", "0", "0", "0", "0", "-", "-", "-"]
    assert "Labels" not in text(SIMULATION)


def test_a_missed_limit_says_when():
    late = limit(at=Fraction(20 * MS), reason="2 without a target")
    assert cells(text(with_requirements(late)), "R")[-1].strip() == "2 without a target, at 20 ms"
    kept = replace(late, verdict=ObservedVerdict.OK, reason="")
    assert "at 20 ms" not in text(with_requirements(kept))
    assert content(with_requirements(kept))["requirements"][0]["at_ps"] == 20 * MS


def test_a_constraint_without_a_number_is_told_by_its_reason():
    order = limit(quantity="order of runnables", limit=None, value=None, reason="2 of 9 jobs in another order", is_time=False)
    assert "order of runnables of Control: 2 of 9 jobs in another order" in closing_line(with_requirements(order))


def test_runnables_and_labels_for_programs():
    found = content(WITH_PARTS)
    (runnable,), (label, unread) = found["runnables"], found["labels"]
    assert (runnable["executions"], runnable["metrics"]["response_time"]["max_ps"]) == (300, 9 * US)
    numbers = {"name": "speed", "reads": 1200, "writes": 300, "unwritten_reads": 4, "overwritten": 7}
    assert {name: label[name] for name in numbers} == numbers
    assert (label["age"]["min_ps"], label["age"]["max_ps"], unread["age"]) == (US, 3 * US, None)


def test_requirements_with_missed_ones_first():
    ratio = limit(name="share", quantity="load", limit=Fraction(1, 2), value=Fraction(1, 4), is_time=False)
    shown = text(with_requirements(UNSEEN, replace(ratio, verdict=ObservedVerdict.OK), SLOW))
    assert [cell.strip() for cell in cells(shown, "slow")] == [
        *("slow", "response time of Control", "at most 28 us", "29 us", "observed missed", "-1 us")
    ]
    assert [cell.strip() for cell in cells(shown, "share")] == [
        *("share", "load of Control", "at most 0.5", "0.25", "observed ok", "0.25")
    ]
    assert "no job of 'Control' ended" in shown
    assert shown.index("slow") < shown.index("unseen") < shown.index("share")


def test_the_assumptions_are_shown():
    assert "Assumptions\n  registers keep the last value\n" in text(SIMULATION)


# The closing line


@pytest.mark.parametrize(
    ("simulation", "expected"),
    [
        (SIMULATION, "no deadline missed; tightest: Control, 971 us of 1 ms left"),
        (with_requirements(SLOW), "response time of Control is 29 us, limit at most 28 us"),
        # Two limits of one response time are missed together.
        (with_requirements(SLOW, SLOW), "response time of Control is 29 us, limit at most 28 us"),
        (
            with_requirements(UNSEEN),
            "no deadline or requirement missed; tightest: Control, 971 us of 1 ms left; "
            "not observed: 1 of 3, because of 'unseen': no job of 'Control' ended",
        ),
        (
            replace(SIMULATION, processes=Results([replace(CONTROL, deadline=20 * US, verdict=ObservedVerdict.MISSED)])),
            "Control responds after 29 us, deadline 20 us",
        ),
        (
            replace(
                SIMULATION, processes=Results([replace(CONTROL, verdict=ObservedVerdict.MISSED, reason="2 activations lost")])
            ),
            "Control: 2 activations lost",
        ),
        (
            replace(SIMULATION, processes=Results([replace(CONTROL, verdict=None)])),
            "no deadline, requirement or constraint to judge",
        ),
    ],
)
def test_the_closing_line_says_what_was_observed_and_that_this_is_no_bound(simulation, expected):
    line = f"Observed over 5 min (seed 7): {expected}. Observed values are no bounds; for bounds use `amuros analyze`."
    assert closing_line(simulation) == line
    assert text(simulation).splitlines()[-1] == line


def test_what_was_not_simulated_comes_first():
    left_out = Finding("SIM001", Severity.ERROR, "'Task_A' is not simulated: its execution time is not known")
    warning = Finding("SIM002", Severity.WARNING, "'chain' is not followed")
    line = closing_line(replace(SIMULATION, findings=(left_out, warning)))
    assert line.startswith(
        "Observed over 5 min (seed 7): 'Task_A' is not simulated: its execution time is not known; no deadline"
    )
    nothing = replace(SIMULATION, processes=Results(), findings=(left_out, left_out))
    assert closing_line(nothing).startswith(
        "Observed over 5 min (seed 7): nothing was executed: 'Task_A' is not simulated: its execution time is not known; "
        "1 other error; "
    )


def test_if_nothing_was_observed_nothing_is_praised():
    unseen = replace(CONTROL, verdict=ObservedVerdict.NOT_OBSERVED, metrics={}, reason="no job ended")
    line = closing_line(replace(SIMULATION, processes=Results([unseen])))
    assert line.startswith("Observed over 5 min (seed 7): not observed: 1 of 1, because of 'Control': no job ended. ")


@pytest.mark.parametrize(
    ("duration", "expected"), [(60 * SECOND, "1 min"), (90 * SECOND, "90 s"), (1500 * MS, "1.5 s"), (20 * US, "20 us")]
)
def test_durations(duration, expected):
    assert duration_text(duration) == expected


# JSON


def test_json_has_the_fixed_names():
    finding = Finding("SIM001", Severity.WARNING, "not simulated")
    found = content(with_requirements(SLOW), findings=(finding,))
    assert found["model"] == "app.yaml"
    assert (found["duration_ps"], found["seed"], found["mode"]) == (300 * SECOND, 7, "sampled")
    assert found["assumptions"] == ["registers keep the last value"]
    assert [each["rule"] for each in found["findings"]] == ["SIM001"]
    assert found["processors"] == [{"name": "Core", "load": 0.0167}, {"name": "Idle", "load": 0.0}]
    assert found["lost_activations"] == 0
    assert found["amuros"]


def test_json_of_a_process():
    control = content(SIMULATION)["processes"][1]
    assert (control["name"], control["kind"], control["jobs"], control["load"]) == ("Control", "task", 300, 0.004)
    assert control["priority"] == 1
    response = control["metrics"]["response_time"]
    assert (response["min_ps"], response["avg_ps"], response["max_ps"]) == (16 * US, 16_650_000, 29 * US)
    assert (response["jitter_ps"], response["at_max"]) == (13 * US, {"instance": 20, "time_ps": 20 * MS})
    assert (control["deadline_ps"], control["verdict"]) == (MS, "observed_ok")


def test_json_of_a_chain():
    (chain,) = content(SIMULATION)["chains"]
    assert (chain["name"], chain["observations"], chain["unanswered"]) == ("way", 300, 1)
    reaction = chain["quantities"]["reduced_reaction_time"]
    assert (reaction["min_ps"], reaction["avg_ps"], reaction["max_ps"]) == (MS, 10_516_650_000, 20 * MS)
    assert reaction["histogram"] == {"edges_ps": [0, 10 * MS, 20 * MS], "counts": [100, 200]}
    assert [route["text"] for route in chain["routes"]] == ["Executor_start -[data memory]-> Control_finish"]


def test_json_of_requirements():
    share = limit(quantity="load", limit=Fraction(1, 2), value=Fraction(1, 4), is_time=False, verdict=ObservedVerdict.OK)
    slow, other, unseen = content(with_requirements(SLOW, share, UNSEEN))["requirements"]
    assert (slow["limit_ps"], slow["value_ps"], slow["margin_ps"]) == (28 * US, 29 * US, -US)
    assert (slow["verdict"], slow["limit"]) == ("observed_missed", None)
    assert (other["limit"], other["value"], other["limit_ps"]) == (0.5, 0.25, None)
    assert (unseen["value_ps"], unseen["verdict"]) == (None, "not_observed")


def test_json_summary():
    found = content(with_requirements(SLOW, UNSEEN))["summary"]
    assert (found["judged"], found["missed"], found["not_observed"]) == (4, 1, 1)
    assert found["tightest"] == {"name": "Control", "margin_ps": MS - 29 * US}
    assert found["text"] == closing_line(with_requirements(SLOW, UNSEEN))
