"""Measured times in a description: what was simulated with other values comes back, and nothing is narrowed or lost silently."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from measurements import measurement, series
from support import ROOT

from amalthea_uros import InvalidArgumentError, Options, WriteError, analyze, calibrate, simulate, simulate_files
from amalthea_uros.compare.calibration.values import Outcome
from amalthea_uros.measure.series import MeasuredKind, statistics_of
from amalthea_uros.services.measure import measure
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import MICROSECOND, MILLISECOND, SECOND, Duration
from amalthea_uros.uros.described import describe_text

SAMPLES = ROOT / "samples"
ADVANCED = (SAMPLES / "bodas-test-advanced.yaml").read_text()
#: The same application, as somebody guessed it before measuring.
GUESSED = (
    ADVANCED.replace("base: 12 us, per_message: 13 us", "base: 5 us, per_message: 3 us")
    .replace("execution_time: 2 us", "execution_time: 1 us")
    .replace("execution_time: 4 us", "execution_time: 9 us")
)


def control(*times, quantity="net_execution_time", **more):
    return measurement(series("Control_Function", quantity, times, **more))


def line_of(text, start):
    return next(line for line in text.split("\n") if line.strip().startswith(start))


@pytest.fixture(scope="module")
def trace(tmp_path_factory):
    """A trace of the application as it is, 2 s long."""
    path = tmp_path_factory.mktemp("trace") / "run.btf"
    options = Options(duration=Duration(2 * SECOND), traced=(0, Duration(2 * SECOND)))
    simulate_files(SAMPLES / "bodas-test-advanced.yaml", options, trace_paths=[path])
    return path


# The closed loop


def test_the_values_of_the_measured_system_come_back(trace):
    result = calibrate(GUESSED, trace, margin=0, tighten=True)
    assert "execution_time: {base: 12 us, per_message: 13 us}" in result.text
    assert "execution_time: 2 us" in result.text
    assert "execution_time: 4 us" in result.text
    old, new = (describe_text(text).assembly.system for text in (ADVANCED, result.text))
    assert old == new


def test_the_analysis_of_the_calibrated_file_bounds_what_was_measured(trace):
    result = calibrate(GUESSED, trace, tighten=True)
    predicted = {each.name: each.response.worst for each in analyze(result.text).processes}
    for name in ("Executor_Task", "Control_Function"):  # no job of Message_Factor comes with a message in this run
        longest = measure(trace).find(name, "response_time").statistics.max
        # Each of up to four parts is rounded up to a tick of 1 us.
        assert longest <= predicted[name] <= longest * Fraction(6, 5) + 4 * MICROSECOND


def test_a_histogram_predicts_the_mean(trace):
    # 12 us and, in one of 20 jobs, 13 us more: the thesis's 12.65 us.
    result = calibrate(GUESSED, trace, form="histogram", tighten=True)
    observed = {each.name: each for each in simulate(result.text, duration="1 s").processes}
    assert observed["Executor_Task"].metrics[JobMetric.NET_EXECUTION_TIME].mean == pytest.approx(12.65 * MICROSECOND)


def test_the_thesis_subtracts_empty_tasks_before_the_times_go_into_the_model():
    log = SAMPLES / "bodas-test-measured.log"
    found = measure(log, markers=SAMPLES / "bodas-test-measured.markers.yml")
    result = calibrate(SAMPLES / "bodas-test-measured.yaml", found, form="histogram", tighten=True)
    observed = {each.name: each for each in simulate(result.text, duration="1 s").processes}
    # 41 + 12.65 + 4 us: the prediction of the thesis for executor and control function.
    assert observed["Control_Function"].response_time.mean == pytest.approx(57.65 * MICROSECOND, rel=0.02)
    assert {value.target: value.outcome for value in result.values}["Executor_Task.overhead"] is Outcome.CONFIRMED
    assert not [finding for finding in result.findings if finding.rule == "CAL008"]  # the empty tasks are used


def test_the_cost_of_a_message_is_found_in_jobs_as_a_whole():
    found = series("Executor_Task", "net_execution_time", ([12] * 19 + [25]) * 10)
    result = calibrate(GUESSED, measurement(found), margin=0, tighten=True)
    assert "execution_time: {base: 12 us, per_message: 13 us}" in result.text


def test_jobs_that_do_not_come_as_often_as_messages_are_not_separated():
    found = series("Executor_Task", "net_execution_time", ([12] * 9 + [25]) * 20)
    result = calibrate(GUESSED, measurement(found))
    (value,) = result.values
    assert value.outcome is Outcome.NOT_WRITTEN
    assert "base, per_message" in value.reason
    assert result.text == GUESSED


# Bounds, margins and what is kept


def test_a_refuted_bound_is_an_error_and_is_widened():
    result = calibrate(ADVANCED, control(3, 5), margin="0%")
    assert "execution_time: {min: 3 us, max: 5 us}" in result.text
    (finding,) = [each for each in result.findings if each.rule == "CAL001"]
    assert finding.location.line == 17
    assert "(4 us)" in finding.message
    assert result.is_refuted


@pytest.mark.parametrize(
    ("described", "tighten", "expected"),
    [
        # 10 us - 20 % and 20 us + 20 %; 15 us is within.
        ("4 us", True, "{min: 8 us, max: 24 us}"),
        ("{min: 1 us, max: 90 us}", False, "{min: 1 us, max: 90 us}"),
        ("{min: 1 us, max: 90 us}", True, "{min: 8 us, max: 24 us}"),
        ("{min: 1 us, max: 15 us}", False, "{min: 1 us, max: 24 us}"),
    ],
)
def test_bounds_are_widened_by_a_margin_and_narrowed_only_if_asked_for(described, tighten, expected):
    text = ADVANCED.replace("execution_time: 4 us", f"execution_time: {described}")
    result = calibrate(text, control(10, 15, 20), tighten=tighten)
    assert f"execution_time: {expected}" in result.text
    assert ([value.outcome for value in result.values] == [Outcome.KEPT]) is (result.text == text) is (expected == described)


def test_values_that_are_not_used_judge_the_others():
    # Calibrated on 10, 10, 10; judged on 13, which is beyond 10 us + 20 %.
    result = calibrate(ADVANCED, control(10, 10, 10, 13), judge_on="25%", tighten=True)
    assert "{min: 8 us, max: 12 us}" in result.text
    assert [each.rule for each in result.findings if each.rule == "CAL007"] == ["CAL007"]
    assert not [each for each in calibrate(ADVANCED, control(10, 10, 10, 11), judge_on=0.25).findings if each.rule == "CAL007"]


EMPTY = statistics_of(np.array([40, 42]) * MICROSECOND)


def test_the_spread_of_an_empty_task_widens_bounds():
    # Measured 50 and 60 us, empty 40 to 42 us: net times are between 50 - 42 and 60 - 40 us.
    result = calibrate(ADVANCED, control(9, 19, baseline=EMPTY), margin=0, tighten=True)
    assert "{min: 8 us, max: 20 us}" in result.text
    assert "overhead: {min: 40 us, max: 42 us}" in result.text


def test_a_value_within_the_spread_of_an_empty_task_refutes_nothing():
    result = calibrate(ADVANCED.replace("execution_time: 4 us", "execution_time: 10 us"), control(10, 10.9, baseline=EMPTY))
    assert not result.is_refuted


def test_an_overhead_that_the_description_states_is_part_of_measured_jobs():
    text = ADVANCED.replace("execution_time: 4 us", "overhead: 30 us, execution_time: 4 us")
    result = calibrate(text, control(40, 50), margin=0, tighten=True)
    assert "execution_time: {min: 10 us, max: 20 us}" in result.text


def test_gross_times_are_used_with_a_warning():
    result = calibrate(ADVANCED, control(5, quantity="duration", kind=MeasuredKind.INTERVAL))
    assert [each.rule for each in result.findings if each.rule == "CAL005"]
    assert result.written


# Periods and messages


def distances(name, *milliseconds, quantity="start_to_start"):
    return series(name, quantity, (1000 * each for each in milliseconds))


def test_a_period_on_offer_is_written_if_the_clock_allows_it():
    # 50 parts in a million are within the error of two clocks.
    result = calibrate(ADVANCED, measurement(distances("Control_Function", *[10.0005] * 100)))
    assert "name: Control_Function, period: 10 ms" in result.text


@pytest.mark.parametrize("mean", [1.5, 10.05])
def test_other_periods_are_told(mean):
    result = calibrate(ADVANCED, measurement(distances("Control_Function", *[mean] * 100)))
    assert result.text == ADVANCED
    assert [each.rule for each in result.findings if each.rule.startswith("CAL00")][:2] == ["CAL001", "CAL003"]


def test_a_period_as_described_is_confirmed():
    result = calibrate(ADVANCED, measurement(distances("Control_Function", *[0.987, 1.013] * 50)))
    assert [value.outcome for value in result.values] == [Outcome.CONFIRMED]


def test_the_jitter_of_messages_is_that_of_all_against_one_grid():
    # Delays of 0, 1, 2, 3 ms: neighbours differ by 1 ms only, but the messages are up to 3 ms late.
    delays = [0, 1, 2, 3, 2, 1] * 20
    times = np.array([20 * number + delay for number, delay in enumerate(delays)])
    result = calibrate(ADVANCED, measurement(distances("factor", *np.diff(times))))
    (jitter,) = [value for value in result.values if value.target == "Message_Factor.arrival_jitter"]
    (subscription,) = describe_text(result.text).assembly.messages
    assert jitter.outcome is Outcome.WRITTEN
    assert subscription.message.interval == 17 * MILLISECOND


def test_an_interval_of_messages_replaces_the_rate():
    result = calibrate(ADVANCED, measurement(distances("factor", *[40] * 50)))
    assert "topic: factor, interval: 40 ms, message_size" in result.text


# What is said, and files


def test_a_comment_says_where_a_value_comes_from():
    text = calibrate(ADVANCED, control(3, 4, 5)).text
    assert line_of(text, "# Control_Function.execution_time:").strip() == (
        "# Control_Function.execution_time: measured in run.log (sha256 abababababab): n 3, min 3 us, mean 4 us, max 5 us; "
        "margin 20 %; the maximum is a high-water mark, not a bound"
    )
    again = calibrate(text, control(1, 9))
    assert again.text.count("# Control_Function.execution_time:") == 1


def test_a_name_may_be_that_of_another_object():
    result = calibrate(ADVANCED, measurement(series("Control_Funktion", "net_execution_time", [3])))
    finding = next(each for each in result.findings if each.rule == "CAL008")
    assert finding.help.startswith("Did you mean 'Control_Function'")


def test_a_file_is_replaced_as_a_whole(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + ADVANCED.replace("\n", "\r\n").encode())
    result = calibrate(path, control(3, 5))
    result.write(path)
    written = path.read_bytes()
    assert written.startswith(b"\xef\xbb\xbf# The test")
    assert written.count(b"\r\n") == written.count(b"\n") == ADVANCED.count("\n") + 1
    assert calibrate(path, control(3, 5)).text == written.decode()
    with pytest.raises(WriteError):
        result.write(tmp_path / "missing" / "app.yaml")
    assert [each.name for each in tmp_path.iterdir()] == ["app.yaml"]


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({"margin": "much"}, "not a share"),
        ({"margin": "-5%"}, "negative"),
        ({"judge_on": "100%"}, "less than all"),
        ({"form": "mode"}, "unknown form"),
    ],
)
def test_wrong_options_are_refused(options, reason):
    with pytest.raises(InvalidArgumentError, match=reason):
        calibrate(ADVANCED, control(3), **options)


def test_only_descriptions_are_calibrated():
    with pytest.raises(InvalidArgumentError, match="only an app"):
        calibrate(SAMPLES / "bodas-test-advanced.amxmi", control(3))
    with pytest.raises(InvalidArgumentError, match="nothing was measured"):
        calibrate(Path("app.yaml").name + "\n", [])


def test_values_that_make_a_description_impossible_are_refused():
    # An execution time of 2 ms does not fit into a period of 1 ms.
    with pytest.raises(InvalidArgumentError, match="not valid"):
        calibrate(ADVANCED, control(2000))


def test_a_calibration_is_a_table():
    rows = calibrate(ADVANCED, control(3, 5)).to_records()
    assert rows[0]["target"] == "Control_Function.execution_time"
    assert (rows[0]["min_ps"], rows[0]["max_ps"]) == (3 * MICROSECOND, 5 * MICROSECOND)


# Text that is written otherwise than in the samples.


UGLY = """\
amuros: 1
name: ugly
hardware: {platform: single-core}
tasks:
  - {reads: ["a
      b"], name: A, period: 1 ms, execution_time: 4 us}
  - &b {name: B, period: 2 ms, execution_time: 4 us}
  - {<<: *b, name: C}
  - &d {name: D, period: 4 ms, execution_time: 4 us}
  - {<<: *d, name: E, execution_time: 5 us}
"""


def of_tasks(**times):
    return measurement(*(series(name, "net_execution_time", each) for name, each in times.items()))


def test_a_comment_is_no_part_of_a_text_of_several_lines():
    result = calibrate(UGLY, of_tasks(A=[3, 5]))
    labels = [{label.name for label in describe_text(text).assembly.system.software.labels} for text in (UGLY, result.text)]
    assert labels[0] == labels[1] == {"a b"}
    assert '"a\n      b"], name: A, period: 1 ms, execution_time: {min: 2 us, max: 6 us}}' in result.text


def test_a_value_that_others_share_by_merging_is_not_written():
    result = calibrate(UGLY, of_tasks(B=[3, 5], A=[3, 5]))
    (shared,) = (value for value in result.values if value.target == "B.execution_time")
    assert shared.outcome is Outcome.NOT_WRITTEN
    assert "shared through the anchor &b" in shared.reason
    assert "- &b {name: B, period: 2 ms, execution_time: 4 us}" in result.text
    assert [value.target for value in result.written] == ["A.execution_time"]  # the others are written nevertheless
    assert any(finding.rule == "CAL003" for finding in result.findings)


def test_what_the_others_state_themselves_is_not_shared():
    assert [value.target for value in calibrate(UGLY, of_tasks(D=[3, 5])).written] == ["D.execution_time"]


def test_the_order_of_values_that_share_something_does_not_matter():
    # C gets a value of its own; only then nobody shares that of B any longer.
    once = calibrate(UGLY, of_tasks(B=[3, 5], C=[3, 5]))
    assert len(once.written) == 2
    assert calibrate(once.text, of_tasks(B=[3, 5], C=[3, 5])).text == once.text
