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
    return [cell.strip() for cell in row.strip().split("  ") if cell]


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


SILENT = replace(CONTROL, jobs=0, metrics={}, core=None, deadline=None, verdict=None)
LATE = limit(at=Fraction(20 * MS), reason="2 without a target")
SHARE = limit(
    name="share", quantity="load", limit=Fraction(1, 2), value=Fraction(1, 4), is_time=False, verdict=ObservedVerdict.OK
)


@pytest.mark.parametrize(
    ("simulation", "row"),
    [
        (SIMULATION, "Control | Core | 300 | 0.4 % | 16 us | 16.65 us | 29 us | 1 ms | 0 | observed ok"),
        (replace(SIMULATION, processes=Results([SILENT])), "Control | - | 0 | 0.4 % | - | - | - | - | 0 | -"),
        (SIMULATION, "way | 300 | 1 ms | 10.52 ms | 20 ms | 39 ms | 1"),
        (WITH_PARTS, "Callback | 300 | 2 us | 5 us | 9 us | 4 us"),
        (WITH_PARTS, "speed | 1,200 | 300 | 4 | 7 | 1 us | 2 us | 3 us"),
        (WITH_PARTS, "unread | 0 | 0 | 0 | 0 | - | - | -"),
        (with_requirements(SLOW), "slow | response time of Control | at most 28 us | 29 us | observed missed | -1 us"),
        (with_requirements(SHARE), "share | load of Control | at most 0.5 | 0.25 | observed ok | 0.25"),
    ],
)
def test_the_row_of_a_thing(simulation, row):
    assert cells(text(simulation), row.partition(" | ")[0]) == row.split(" | ")


def test_a_missed_limit_says_when_and_is_before_those_that_are_kept():
    assert cells(text(with_requirements(LATE)), "R")[-1] == "2 without a target, at 20 ms"
    assert "at 20 ms" not in text(with_requirements(replace(LATE, verdict=ObservedVerdict.OK, reason="")))
    shown = text(with_requirements(UNSEEN, SHARE, SLOW))
    assert shown.index("slow") < shown.index("unseen") < shown.index("share")
    assert "no job of 'Control' ended" in shown


@pytest.mark.parametrize(
    ("processes", "order"),
    [
        ([CONTROL, replace(EXECUTOR, is_isr=True)], ["Executor", "Control"]),
        (
            [
                replace(CONTROL, name=name, priority=priority)
                for name, priority in {"Low": 1, "Unknown": None, "High": 10, "Middle": 2}.items()
            ],
            ["High", "Middle", "Low", "Unknown"],
        ),
    ],
    ids=["interrupts first", "by priority, unknown ones last"],
)
def test_the_order_of_the_processes_of_a_core(processes, order):
    shown = text(replace(SIMULATION, processes=Results(processes)))
    assert sorted(order, key=shown.index) == order


def test_metrics_are_shown_on_request_in_microseconds_rounded_outwards():
    assert "Metrics of" not in text(SIMULATION)
    shown = text(SIMULATION, with_metrics=True).split("Metrics of Control (us)")[1]
    assert cells(shown, "response time") == ["response time", "16.000", "16.650", "29.000"]
    metrics = {JobMetric.LATENESS: observation(Fraction(-20, 3), Fraction(-1), Fraction(20, 3))}
    shown = text(replace(SIMULATION, processes=Results([replace(CONTROL, metrics=metrics)])), with_metrics=True)
    assert cells(shown, "lateness") == ["lateness", "-0.001", "-0.001", "0.001"]


def test_what_there_is_and_what_is_left_out():
    shown = text(SIMULATION)
    assert "period 1 ms" in cells(shown, "Executor")
    assert "Assumptions\n  registers keep the last value\n" in shown
    assert "1.67 %" in shown
    assert "Idle" not in shown
    assert "Labels" not in shown
    chain = replace(CHAIN, routes=(replace(CHAIN.routes[0], not_evaluated=1200),))
    assert "1,200 latencies too long to be observed" in text(replace(SIMULATION, chains=Results([chain])))


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
        # Four digits, rounded away from the limit.
        (
            with_requirements(limit(value=Fraction(2_433_707_081, 1000) * US, limit=Fraction(US))),
            "response time of Control is 2.434 s, limit at most 1 us",
        ),
        (
            with_requirements(limit(value=Fraction(28_000_001, 10**6) * US)),
            "response time of Control is 28.01 us, limit at most 28 us",
        ),
        (
            with_requirements(
                limit(quantity="normalized response time", value=Fraction(4, 3), limit=Fraction(1), is_time=False)
            ),
            "normalized response time of Control is 1.334, limit at most 1",
        ),
        (
            replace(
                SIMULATION, processes=Results([replace(CONTROL, verdict=ObservedVerdict.MISSED, reason="2 activations lost")])
            ),
            "Control: 2 activations lost",
        ),
        (
            replace(
                SIMULATION,
                processes=Results(
                    [replace(CONTROL, deadline=20 * US, verdict=ObservedVerdict.MISSED, reason="2 activations lost")]
                ),
            ),
            "Control responds after 29 us, deadline 20 us; 2 activations lost",
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
    ("duration", "expected"),
    [(60 * SECOND, "1 min"), (90 * SECOND, "90 s"), (1500 * MS, "1.5 s"), (20 * US, "20 us"), (199_849_841_391, "199.8 ms")],
)
def test_durations(duration, expected):
    assert duration_text(duration) == expected


# JSON


def at(found, path):
    """The value at a path such as `processes.1.name`."""
    for key in path.split("."):
        found = found[int(key) if key.isdigit() else key]
    return found


def test_the_json_output_has_the_fixed_names():
    simulation = replace(WITH_PARTS, requirements=Results([SLOW, SHARE, UNSEEN, replace(LATE, verdict=ObservedVerdict.OK)]))
    found = content(simulation, findings=(Finding("SIM001", Severity.WARNING, "not simulated"),))
    assert found["amuros"]
    processors = [{"name": "Core", "load": 0.0167}, {"name": "Idle", "load": 0.0}]
    response, latency = "processes.1.metrics.response_time", "chains.0.quantities.reduced_reaction_time"
    expected = {
        "model": "app.yaml",
        "duration_ps": 300 * SECOND,
        "seed": 7,
        "mode": "sampled",
        "assumptions": ["registers keep the last value"],
        "findings.0.rule": "SIM001",
        "processors": processors,
        "lost_activations": 0,
        "processes.1.name": "Control",
        "processes.1.kind": "task",
        "processes.1.jobs": 300,
        "processes.1.load": 0.004,
        "processes.1.priority": 1,
        "processes.1.deadline_ps": MS,
        "processes.1.verdict": "observed_ok",
        f"{response}.min_ps": 16 * US,
        f"{response}.avg_ps": 16_650_000,
        f"{response}.max_ps": 29 * US,
        f"{response}.jitter_ps": 13 * US,
        f"{response}.at_max": {"instance": 20, "time_ps": 20 * MS},
        "chains.0.name": "way",
        "chains.0.observations": 300,
        "chains.0.unanswered": 1,
        f"{latency}.min_ps": MS,
        f"{latency}.avg_ps": 10_516_650_000,
        f"{latency}.max_ps": 20 * MS,
        f"{latency}.histogram": {"edges_ps": [0, 10 * MS, 20 * MS], "counts": [100, 200]},
        "chains.0.routes.0.text": "Executor_start -[data memory]-> Control_finish",
        "runnables.0.executions": 300,
        "runnables.0.metrics.response_time.max_ps": 9 * US,
        "labels.0.name": "speed",
        "labels.0.reads": 1200,
        "labels.0.writes": 300,
        "labels.0.unwritten_reads": 4,
        "labels.0.overwritten": 7,
        "labels.0.age.min_ps": US,
        "labels.0.age.max_ps": 3 * US,
        "labels.1.age": None,
        "requirements.0.limit_ps": 28 * US,
        "requirements.0.value_ps": 29 * US,
        "requirements.0.margin_ps": -US,
        "requirements.0.verdict": "observed_missed",
        "requirements.0.limit": None,
        "requirements.3.at_ps": 20 * MS,
        "requirements.1.limit": 0.5,
        "requirements.1.value": 0.25,
        "requirements.1.limit_ps": None,
        "requirements.2.value_ps": None,
        "requirements.2.verdict": "not_observed",
        "summary.judged": 6,
        "summary.missed": 1,
        "summary.not_observed": 1,
        "summary.text": closing_line(simulation),
        "summary.tightest": {"name": "R", "margin_ps": -US},
    }
    assert {path: at(found, path) for path in expected} == expected
