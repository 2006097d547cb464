"""Measuring files: logs of a CAN bus with markers, traces of events, tables of values."""

import gzip
import math
import random
import struct
from fractions import Fraction
from itertools import pairwise

import pytest
from command import amuros as command
from ctf_traces import write_zephyr, zephyr_event
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.measure.series import MeasuredKind
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS

LOG, MARKERS = (ROOT / "samples" / f"bodas-test-measured.{end}" for end in ("log", "markers.yml"))


def log(folder, *frames, name="a.log"):
    """A log of frames: microseconds, identifier with payload, bus."""
    path = folder / name
    rows = ((time, frame if "#" in frame else f"{frame}#", *bus) for time, frame, *bus in frames)
    path.write_text("".join(f"(1600000000.{time:06}) {(*bus, 'can0')[0]} {frame}\n" for time, frame, *bus in rows))
    return path


def jobs(numbers, length=40):
    """The frames at the begin and the end of a job each millisecond."""
    return [(1000 * job + wait, f"{marker}#{job:02X}") for job in numbers for wait, marker in ((0, "101"), (length, "102"))]


def markers(folder, text):
    path = folder / "m.yaml"
    path.write_text(text)
    return path


#: The markers of an object, and of one that is empty.
WORK_AND_EMPTY = "Work: {start: 101, end: '102'}\nEmpty: {start: '103', end: '104'}\n"


def rules(measurement):
    return [finding.rule for finding in measurement.findings]


def microseconds(series):
    return [value // US for value in series.values.tolist()]


def test_the_sample_has_what_was_put_into_it():
    """12 us, and 25 us with each 20th message, beside 41 us and 31 us of empty tasks: the figures of the thesis."""
    found = amuros.measure(LOG, markers=MARKERS)
    fast, slow = (found.find(name, "duration").statistics for name in ("Empty_1kHz", "Empty_50Hz"))
    assert abs(fast.mean - 41 * US) < US / 4
    assert abs(slow.mean - 31 * US) < US / 2
    executor = found.find("Executor_Task", "net_execution_time")
    assert abs(executor.statistics.mean - Fraction(1265, 100) * US) < US / 4
    low, high = executor.net_range
    assert low <= 12 * US <= 25 * US <= high
    assert found.find("Control_Function", "start_to_start").statistics.count == 199


def test_a_baseline_is_a_distribution(tmp_path):
    """The interval of the net times is [min a - max o, max a - min o]; the thesis subtracts the mean."""
    works = [frame for job, time in enumerate((50, 60, 70)) for frame in ((1000 * job, "101"), (1000 * job + time, "102"))]
    empties = [(500, "103"), (510, "104"), (1500, "103"), (1514, "104")]
    path = log(tmp_path, *sorted(works + empties))
    found = amuros.measure(path, markers=markers(tmp_path, WORK_AND_EMPTY), baseline="Empty")
    work = found.find("Work", "duration")
    assert work.net_range == (36 * US, 60 * US)
    assert (work.statistics.min, work.statistics.mean, work.statistics.max) == (38 * US, 48 * US, 58 * US)
    assert work.baseline.mean == 12 * US
    # Neither the empty object itself nor distances contain the cost.
    assert found.find("Empty", "duration").baseline is None
    assert found.find("Work", "start_to_start").baseline is None


def test_a_baseline_can_be_in_another_log(tmp_path):
    work = log(tmp_path, (0, "101"), (50, "102"), name="work.log")
    empty = log(tmp_path, (0, "103"), (10, "104"), name="empty.log")
    found = amuros.measure(work, markers=markers(tmp_path, WORK_AND_EMPTY), baseline="Empty", baseline_from=empty)
    assert microseconds(found.find("Work", "duration")) == [40]


def test_a_missing_baseline_is_an_error(tmp_path):
    path = log(tmp_path, (0, "101"), (50, "102"))
    text = WORK_AND_EMPTY.replace("'102'", "'102', baseline: Empty")
    found = amuros.measure(path, markers=markers(tmp_path, text))
    assert "MEA012" in rules(found)
    assert found.find("Work", "duration").baseline is None


def test_the_same_identifiers_on_two_buses_are_never_mixed(tmp_path):
    path = log(tmp_path, (0, "101", "can0"), (10, "101", "can1"), (30, "102", "can0"), (70, "102", "can1"))
    found = amuros.measure(path, start="101", end="102", name="Task")
    assert {series.name: microseconds(series) for series in found.series} == {"can0:Task": [30], "can1:Task": [60]}
    assert "MEA002" in rules(found)
    only = amuros.measure(path, start="101", end="102", name="Task", channel="can1")
    assert microseconds(only.find("Task", "duration")) == [60]
    assert "MEA002" not in rules(only)


def test_a_damaged_name_of_a_bus_is_no_second_bus(tmp_path):
    frames = jobs(range(100))
    frames[50] = (*frames[50], "c\x07n0")
    found = amuros.measure(log(tmp_path, *frames), start="101", end="102", name="Task")
    assert {series.name for series in found.series} == {"Task"}
    (finding,) = (finding for finding in found.findings if finding.rule == "MEA002")
    assert "1 frame of 'Task' on 1 bus" in finding.message


@pytest.mark.parametrize("wrong", [900_000, 5])
@pytest.mark.parametrize("options", [{}, {"counter": "byte 0"}])
@pytest.mark.parametrize("place", [50, 51])
def test_a_damaged_stamp_makes_no_time_longer(wrong, options, place, tmp_path):
    """A frame that seems to be late or early: both sides of the step back are left out."""
    frames = jobs(range(1, 100))
    frames[place] = (wrong, frames[place][1])
    found = amuros.measure(log(tmp_path, *frames), start="101", end="102", **options)
    duration, distance = found.series
    assert set(microseconds(duration)) == {40}
    assert duration.statistics.count >= 97
    assert duration.counts.reordered == 2
    assert set(microseconds(distance)) == {1000}


def test_a_marker_that_does_not_occur_is_an_error_with_advice(tmp_path):
    found = amuros.measure(log(tmp_path, (0, "101"), (5, "102")), start="101", end="00000102")
    missing = next(finding for finding in found.findings if finding.rule == "MEA001")
    assert "all eight digits" in missing.help
    assert "MEA005" in rules(found)


@pytest.mark.parametrize("options", [{}, {"counter": "byte 0"}])
def test_damage_that_shows_makes_no_value_that_nobody_traced(options, tmp_path):
    """Characters too many, missing or of another kind, cut and repeated lines: only a digit for a digit leaves a line valid."""
    generator = random.Random(7)
    times = [generator.randrange(40, 70) for _ in range(2000)]
    starts = [300 * job + generator.randrange(200) for job in range(2000)]
    frames = [
        (start + wait, f"{marker}#{job % 256:02X}")
        for job, (start, time) in enumerate(zip(starts, times, strict=True))
        for wait, marker in ((0, "101"), (time, "102"))
    ]
    path = log(tmp_path, *frames)
    lines = [damaged(generator, line) if generator.random() < 0.1 else line for line in path.read_text().splitlines()]
    path.write_text("\n".join(lines) + "\n")
    found = amuros.measure(path, start="101", end="102", **options)
    duration, distance = found.series
    known = dict(zip(starts, times, strict=True))
    for value, end in zip(microseconds(duration), duration.times.tolist(), strict=True):
        assert known[starts[0] + end // US - value] == value
    assert set(microseconds(distance)) <= {later - earlier for earlier, later in pairwise(starts)}
    assert duration.statistics.count > 1500
    assert "MEA013" in rules(found)
    assert any(rule.startswith("CAN") for rule in rules(found))


def damaged(generator, line):
    place = generator.randrange(len(line))
    match generator.randrange(5):
        case 0:
            return line[:place] + line[place + 1 :]
        case 1:
            return line[:place] + generator.choice("0x#( \x00") + line[place:]
        case 2:
            return line[:place] + generator.choice("z?.;\x7f") + line[place + 1 :]
        case 3:
            return line[:place]
        case _:
            return line + "\n" + line


@pytest.mark.parametrize("step", [2_000, 500_000])
def test_a_clock_that_is_set_forward_within_a_job_is_told(step, tmp_path):
    """A job that took so long would look the same: the time is kept, since it may be the one that matters."""
    frames = jobs(range(100))
    frames[101:] = [(time + step, marker) for time, marker in frames[101:]]
    found = amuros.measure(log(tmp_path, *frames), start="101", end="102")
    assert found.series[0].statistics.max == (40 + step) * US
    [finding] = [finding for finding in found.findings if finding.rule == "MEA014"]
    assert (finding.severity, finding.object) == (Severity.WARNING, "interval")
    without = amuros.measure(log(tmp_path, *frames[:100]), start="101", end="102")
    assert "MEA014" not in rules(without)


def test_a_window_leaves_out_the_start_up(tmp_path):
    frames = [
        (10_000 * job + time, marker) for job in range(5) for time, marker in ((0, "101"), (90 if job == 0 else 40, "102"))
    ]
    found = amuros.measure(log(tmp_path, *frames), start="101", end="102", window=("5 ms", "35 ms"))
    assert microseconds(found.series[0]) == [40, 40, 40]
    assert found.duration == 20 * MS + 40 * US


def test_times_of_few_steps_are_reported(tmp_path):
    """4 us in steps of 1 us are known to 25 %."""
    found = amuros.measure(log(tmp_path, *jobs(range(5), 4)), start="101", end="102", name="Task")
    (finding,) = (finding for finding in found.findings if finding.rule == "MEA007")
    assert "4 steps of the clock (1 us)" in finding.message
    assert "+-25 %" in finding.message


def test_reported_statistics_merge_exactly(tmp_path):
    """Two seconds of a controller: 10 values of mean 20, and 30 of mean 40, have the mean 35."""
    path = log(tmp_path, (0, "100#0A141E0A00"), (1000, "100#1E283C1E00"))
    path_of_markers = markers(
        tmp_path,
        "Task: {mean: byte 1, min: byte 0, max: byte 2, count: bytes 3..4, frame: '100', unit: us, kind: process, "
        "quantity: net_execution_time}\n",
    )
    (series,) = amuros.measure(path, markers=path_of_markers).series
    found = series.statistics
    assert (found.count, found.min, found.mean, found.max) == (40, 10 * US, 35 * US, 60 * US)
    assert found.variance is None
    assert found.percentiles == {}
    assert series.values is None
    assert series.kind is MeasuredKind.PROCESS


def test_reported_values_have_the_scale_of_their_unit(tmp_path):
    path = log(tmp_path, (0, "100#E803"), (1000, "100#D007"), (2000, "100#01"))
    path_of_markers = markers(tmp_path, "Task: {value: bytes 0..1, unit: 0.1 us, frame: '100'}\n")
    found = amuros.measure(path, markers=path_of_markers)
    assert microseconds(found.series[0]) == [100, 200]
    assert "MEA003" in rules(found)


@pytest.mark.parametrize(("quantity", "usable"), [("duration", [5]), ("lateness", [5, -3])])
def test_reported_values_that_are_no_times_are_not_used(tmp_path, quantity, usable):
    pytest.importorskip("cantools")
    (tmp_path / "bus.dbc").write_text(
        'VERSION ""\n\nNS_ :\n\nBS_:\n\nBU_: ECU\n\nBO_ 256 Debug: 4 ECU\n SG_ Time : 0|32@1- (1,0) [0|0] "us" ECU\n'
        "SIG_VALTYPE_ 256 Time : 1;\n"
    )
    values = (5.0, 1e30, -1e30, math.nan, math.inf, -3.0)
    path = log(tmp_path, *((1000 * at, f"100#{struct.pack('<f', value).hex()}") for at, value in enumerate(values)))
    path_of_markers = markers(tmp_path, f"Task: {{value: Debug.Time, unit: us, quantity: {quantity}, kind: process}}\n")
    found = amuros.measure(path, markers=path_of_markers, dbc=tmp_path / "bus.dbc")
    assert microseconds(found.series[0]) == usable
    (told,) = [finding.message for finding in found.findings if finding.rule == "MEA003"]
    assert told.startswith(f"{len(values) - len(usable)} frames of 'Task'")


def test_signals_of_a_dbc_file_are_values(tmp_path):
    pytest.importorskip("cantools")
    (tmp_path / "bus.dbc").write_text(
        'VERSION ""\n\nNS_ :\n\nBS_:\n\nBU_: ECU\n\nBO_ 256 Debug: 4 ECU\n SG_ Time : 0|16@1+ (0.5,0) [0|0] "us" ECU\n'
        ' SG_ Job : 16|8@1+ (1,0) [0|0] "" ECU\n'
    )
    path = log(tmp_path, (0, "100#50000100"), (1000, "100#52000200"))
    path_of_markers = markers(tmp_path, "Task: {value: Debug.Time, unit: us}\n")
    found = amuros.measure(path, markers=path_of_markers, dbc=tmp_path / "bus.dbc")
    assert microseconds(found.series[0]) == [40, 41]
    with pytest.raises(ReadError, match="--dbc FILE"):
        amuros.measure(path, markers=path_of_markers)


@pytest.mark.parametrize(
    ("text", "place", "says"),
    [
        ("Task: {start: 101}\n", "1:7", "no key 'end'"),
        ("Task: {start: 101, end: 1x2}\n", "1:25", "not a marker"),
        ("A: {start: '1', end: '2'}\nB: {start: '1', end: '2', counted: x}\n", "2:27", "unknown key 'counted'"),
        ("Task: {start: '1', end: '1'}\n", "1:25", "can be both"),
        ("Task: {start: '1', end: '2', counter: byte 99}\n", "1:39", "not a range"),
        ("Task: {start: '1', end: '2', baseline: Empti}\n", "1:40", "not an object"),
        ("Task: {start: '1', end: '2', kind: chain}\n", "1:36", "no kind"),
        ("C: {from: Taks, to: '2'}\n", "1:11", "neither a marker nor an object"),
        ("Task: {value: byte 0, frame: '1'}\n", "1:7", "has no unit"),
        ("Task: {value: byte 0, unit: us}\n", "1:7", "names no frame"),
        ("Task: 5\n", "1:7", "must have keys"),
        ("[]\n", "1:1", "names objects"),
        ("Task: {kind: process}\n", "1:7", "no markers"),
    ],
)
def test_a_mistake_in_the_markers_has_its_place(text, place, says, tmp_path):
    with pytest.raises(ReadError) as error:
        amuros.measure(LOG, markers=markers(tmp_path, text))
    (finding,) = error.value.findings
    assert str(finding.location).endswith(f"m.yaml:{place}")
    assert says in finding.message


def test_values_in_a_table_are_read_and_written_again(tmp_path):
    found = amuros.measure(LOG, markers=MARKERS)
    run = command("measure", LOG, "--markers", MARKERS, "--output", f"csv={tmp_path / 'values.csv'}")
    assert run.returncode == 0, run.stderr
    again = amuros.measure(tmp_path / "values.csv")
    for series in found.series:
        same = again.find(series.name, series.quantity)
        assert same.statistics == series.statistics
        assert same.kind == series.kind


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("object,value_us\nTask,1.5\nTask,2\n", [1_500_000, 2_000_000]),
        ("object,start_ms,end_ms\nTask,1,1.25\n", [250 * US]),
        # What is no time is counted, and the rest is used.
        ("object,value_ns\nTask,7\nTask,x\nTask\nTask,-1\nTask,1e999\nTask,9\n", [7000, 9000]),
        ("time_s,object,quantity,kind,value_us\n1,Task,duration,interval,3\n", [3 * US]),
    ],
)
def test_a_table_has_its_unit_in_the_header(text, values, tmp_path):
    path = tmp_path / "t.csv"
    path.write_text(text)
    found = amuros.measure(path)
    assert found.find("Task", "duration").values.tolist() == values


def test_hostile_logs_are_measured_or_refused_in_words(tmp_path):
    shuffled = random.Random(1)
    lines = LOG.read_bytes().splitlines(keepends=True)[:300]
    for round_number in range(20):
        text = bytearray(b"".join(shuffled.sample(lines, 200)))
        for _ in range(50):
            text[shuffled.randrange(len(text))] = shuffled.randrange(256)
        path = tmp_path / f"{round_number}.log"
        path.write_bytes(bytes(text))
        found = amuros.measure(path, markers=MARKERS)
        assert found.findings
        for series in found.series:
            assert series.statistics is None or series.kind is not MeasuredKind.INTERVAL or series.statistics.min >= 0


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({}, "--start ID and --end ID"),
        ({"start": "1"}, "add --end"),
        ({"start": "1", "end": "1"}, "can be both"),
        ({"start": "1", "end": "2", "window": ("2 s", "1 s")}, "must end later"),
        ({"start": "18000001", "end": "18000002", "select": ["Task"]}, "unknown measured object 'Task'"),
        ({"start": "18000001", "end": "18000002", "baseline": "Empty"}, "unknown object 'Empty'"),
        ({"counter": "byte 0", "markers": MARKERS}, "a counter belongs to"),
    ],
)
def test_options_that_cannot_be_right_are_refused(options, says):
    with pytest.raises(ValueError, match=says):
        amuros.measure(LOG, **options)


def test_a_folder_of_a_tracer_is_measured(tmp_path):
    """Three jobs of 6 us: ready, switched in, waiting, switched out."""
    steps = (("thread_ready", 0), ("thread_switched_in", 1), ("thread_pending", 5), ("thread_switched_out", 6))
    events = [zephyr_event(1000 * (100 * job + at), name, (1, "control")) for job in range(3) for name, at in steps]
    folder = write_zephyr(tmp_path / "ctf", events)
    found = amuros.measure(folder)
    assert microseconds(found.find("control", "response_time")) == [6, 6, 6]
    assert (found.format, len(found.digest)) == ("CTF", 64)
    (folder / "channel0_0").write_bytes(b"".join(events[:-1]))
    assert amuros.measure(folder).digest != found.digest
    refused = command("measure", str(folder), "--markers", str(MARKERS))
    assert (refused.returncode, "not a log of a CAN bus" in refused.stderr) == (2, True)


@pytest.mark.parametrize("end", ["btf", "csv"])
def test_an_event_that_cannot_be_read_makes_no_value_that_nobody_traced(end, tmp_path):
    """A job whose start is damaged would else be one that takes no time, and a missing one would double a period."""
    trace = tmp_path / f"run.{end}"
    run = command("simulate", ROOT / "samples" / "bodas-test-advanced.yaml", "--duration", "60ms", "--trace", trace)
    assert run.returncode == 0, run.stderr
    lines = trace.read_text().splitlines(keepends=True)
    whole = {(series.name, series.quantity): set(series.values.tolist()) for series in amuros.measure(trace).series}
    generator = random.Random(3)
    for _ in range(12):
        place = generator.randrange(len(lines) // 3, len(lines))
        trace.write_text("".join([*lines[:place], "damaged\n", *lines[place + 1 :]]))
        found = amuros.measure(trace)
        assert "TRC002" in rules(found)
        for series in found.series:
            assert set(series.values.tolist()) <= whole[series.name, series.quantity]


def test_a_chain_begins_with_the_activation_or_is_not_measured(tmp_path):
    """A trace that begins between the activation of a job and its first step does not have the begin of that chain."""
    trace = tmp_path / "run.csv"
    command("simulate", ROOT / "samples" / "executor.amxmi", "--duration", "60ms", "--trace", trace)
    header, *lines = trace.read_text().splitlines(keepends=True)
    whole = set(amuros.measure(trace).find("factor_to_output", "reduced_reaction_time").values.tolist())
    for first in range(0, len(lines) // 2, 37):
        trace.write_text("".join([header, *lines[first:]]))
        assert set(amuros.measure(trace).find("factor_to_output", "reduced_reaction_time").values.tolist()) <= whole


@pytest.mark.parametrize("name", ["run.txt", "run", "run.asc", "run.csv", "run.packed"])
def test_a_log_of_candump_is_recognised_whatever_it_is_called(name, tmp_path):
    path = tmp_path / name
    path.write_bytes(gzip.compress(LOG.read_bytes()) if name == "run.packed" else LOG.read_bytes())
    assert amuros.measure(path, markers=MARKERS).series == amuros.measure(LOG, markers=MARKERS).series


def test_a_log_of_an_operating_system_is_none_of_a_bus(tmp_path):
    path = tmp_path / "run.log"
    path.write_text("+0; Control; activate;\n+1000; Control; switch;\n+6000; Control; terminate;\n")
    found = amuros.measure(path)
    assert (found.format, microseconds(found.find("Control", "response_time"))) == ("TRACE32 task events", [6])


def test_the_command_shows_a_table_and_draws_a_picture(tmp_path):
    histogram = f"Executor_Task={tmp_path / 'e.svg'}"
    run = command("measure", LOG, "--markers", MARKERS, "--histogram", histogram, "--output", "markdown")
    assert run.returncode == 0, run.stderr
    assert "| Empty_1kHz | duration | 200 | 40 us | 40.98 us | 42 us |" in run.stdout
    assert "net execution time of Executor_Task" in (tmp_path / "e.svg").read_text()


def test_the_command_refuses_an_unknown_histogram_before_it_writes(tmp_path):
    run = command("measure", LOG, "--markers", MARKERS, "--histogram", f"Executer_Task={tmp_path / 'e.svg'}")
    assert run.returncode == 2
    assert "did you mean 'Executor_Task'" in run.stderr
    assert not list(tmp_path.iterdir())


def test_the_command_measures_what_candump_pipes_into_it():
    run = command("measure", "-", "--start", "18000001", "--end", "18000002", given=LOG.read_text())
    assert run.returncode == 0, run.stderr
    assert "interval  duration        200  52 us" in run.stdout
    # The exit code says that nothing was measured.
    run = command("measure", LOG, "--start", "7FF", "--end", "7FE")
    assert run.returncode == 1
    assert "Nothing was measured" in run.stdout


def test_a_log_that_is_missing_is_said_to_be_missing_also_without_markers(tmp_path):
    with pytest.raises(ReadError, match="TRC001"):
        amuros.measure(tmp_path / "missing.log")
