"""Hosts described from recordings of ros2_tracing, which are written byte by byte, and compared with them."""

from array import array
from contextlib import suppress
from pathlib import Path

import pytest
import robot_recording
from command import amuros as command
from ctf_traces import ros2_writer
from hypothesis import given, settings
from hypothesis import strategies as st
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.compare.recorded.arrivals import arrivals_of
from amalthea_uros.compare.results import Agreement
from amalthea_uros.errors import InvalidArgumentError, ReadError
from amalthea_uros.services.import_recording import import_recording
from amalthea_uros.trace.ctf.ros2_objects import RosSubscription
from amalthea_uros.units import MILLISECOND

T = 5 * 10**9
RECORDING = ROOT / "samples" / "robot-recording"
FILLED = {
    "ros: TODO": "ros: humble",
    "cores: TODO": "cores: 4",
    "latency: TODO": "latency: {min: 50 us, max: 500 us}",
    "type: TODO": "type: single-threaded",
    "policy: TODO": "policy: fifo",
    "core: TODO": "core: 0",
    "jitter: TODO": "jitter: 3 ms",
}
A, B = (1, 10, "first"), (1, 11, "second")


class Recorder:
    """Events of a process with a node that has timers: number n has the handle n and the callback 100 + n."""

    def __init__(self, timers: int = 1) -> None:
        self.w, self.events, self.kernel = ros2_writer(), [], []
        self.add(0, "rcl_node_init", A, 1, 0, "node", "/")
        for number in range(timers):
            self.add(0, "rcl_timer_init", A, number, (number + 1) * 10**6)
            self.add(0, "rclcpp_timer_callback_added", A, number, 100 + number)
            self.add(0, "rclcpp_timer_link_node", A, number, 1)

    def add(self, time: int, name: str, thread: tuple, *values: object) -> None:
        self.events.append((time, self.w.event(T + time, f"ros2:{name}", thread, *values)))

    def call(self, start: int, end: int, callback: int = 100, thread: tuple = A) -> None:
        self.add(start, "callback_start", thread, callback, 0)
        self.add(end, "callback_end", thread, callback)

    def switch(self, time: int, before: int, after: int, priority: int = 20) -> None:
        values = "", before, priority, 1, "", after, priority
        self.kernel.append(self.w.event(T + time, "sched_switch", (0, 0, ""), *values))

    def write(self, folder: Path) -> Path:
        ordered = [event for _, event in sorted(self.events, key=lambda each: each[0])]
        return self.w.write(folder, *([self.w.packet(T, events)] for events in (ordered, self.kernel) if events))

    def imported(self, folder: Path):
        return import_recording(self.write(folder / "trace"))


def line(text: str, key: str) -> str:
    return next(each.strip() for each in text.splitlines() if each.strip().startswith(f"{key}:"))


def messages(result) -> list[str]:
    return [each.message for each in result.findings if each.rule == "IMP027"]


def filled(text: str) -> str:
    for gap, value in FILLED.items():
        text = text.replace(gap, value)
    return text


def test_an_execution_time_is_what_the_thread_has_run_since_the_call_before(tmp_path):
    r = Recorder()
    # The thread runs at 1000-1100, 1200-1300 and 2000-2400: 100 + 50 up to the end of the first call, 50 + 300 of the second one.
    for time, *switched in ((1000, 0, 10), (1100, 10, 0), (1200, 0, 10), (1300, 10, 0), (2000, 0, 10), (2400, 10, 0)):
        r.switch(time, *switched)
    r.call(1010, 1250)
    r.call(2100, 2300)
    result = r.imported(tmp_path)
    # Of the first call, what it took from its own begin on: 90 + 50.
    assert line(result.text, "execution_time") == "execution_time: {min: 140 ns, max: 350 ns} # measured in 2 calls; no bound"
    assert line(result.text, "period") == "period: 1 ms"
    assert line(result.text, "thread") == "thread: {policy: other}"


def test_without_the_scheduler_times_are_gaps(tmp_path):
    r = Recorder()
    r.call(100, 250)
    text = r.imported(tmp_path).text
    assert line(text, "execution_time").startswith("execution_time: TODO # 150 ns to 150 ns in 1 call, with preemption")
    assert line(text, "thread").startswith("thread: TODO")


@pytest.mark.parametrize(
    ("priority", "written"), [(-81, "priority: 80"), (-101, "thread: TODO"), (0, "thread: {policy: other}")]
)
def test_priorities_of_the_kernel(tmp_path, priority, written):
    """SCHED_FIFO and SCHED_RR of 80 are recorded as -81, deadlines as -101."""
    r = Recorder()
    r.switch(50, 0, 10, priority)
    r.call(100, 250)
    text = r.imported(tmp_path).text
    assert line(text, written.partition(":")[0]).startswith(written)
    assert ("policy: TODO" in text) == (priority == -81)


def test_threads_that_call_callbacks_of_a_node_are_one_executor(tmp_path):
    r = Recorder(timers=2)
    r.call(100, 200)
    r.call(150, 250, 101, B)
    text = r.imported(tmp_path).text
    assert line(text, "type").startswith("type: TODO # its class in rclcpp; callbacks were called in 2 threads")
    assert line(text, "threads").startswith("threads: TODO # at least 2")
    assert text.count("executor: first") == 1


def test_what_a_description_cannot_have_is_reported(tmp_path):
    r = Recorder()
    r.add(1, "rcl_service_init", A, 7, 1, 0, "/reset")
    r.add(1, "rclcpp_service_callback_added", A, 7, 200)
    r.add(1, "rcl_publisher_init", A, 8, 9, 1, "/twice", 10)
    r.add(10, "rcl_publish", A, 8, 0)
    r.add(100, "callback_start", A, 100, 0)
    # Each message passes two layers.
    for name, handle in (("rcl_publish", 8), ("rmw_publish", 9), ("rcl_publish", 8), ("rmw_publish", 9)):
        r.add(150, name, A, handle, 0, *((1,) if name == "rmw_publish" else ()))
    r.add(200, "callback_end", A, 100)
    r.add(210, "rcl_publish", A, 99, 0)
    r.call(300, 700, 200)
    result = r.imported(tmp_path)
    assert messages(result) == [
        "'first' calls 'node service /reset' (1 call), which is no timer and no subscription of a known node",
        "'node timer 1 ms' publishes up to 2 messages of '/twice' in one call; a description has one",
        "'/twice' is published outside callbacks, which a description does not have",
        "publishers that are older than the recording sent 1 message; their topics are not known",
    ]
    assert line(result.text, "publishes").startswith("publishes: TODO")
    assert '# Results leave out "node service /reset", which it calls, too: 1 call, 400 ns to 400 ns.' in result.text


def test_a_topic_that_is_published_elsewhere_too_is_a_gap(tmp_path):
    """A timer publishes with the stamp 1; the message with the stamp 2 comes from elsewhere, and one within the process has none."""
    r = Recorder()
    r.add(1, "rcl_publisher_init", A, 8, 9, 1, "/t", 10)
    r.add(1, "rcl_subscription_init", A, 2, 3, 1, "/t", 10)
    r.add(1, "rclcpp_subscription_init", A, 2, 4)
    r.add(1, "rclcpp_subscription_callback_added", A, 4, 5)
    r.add(10, "callback_start", A, 100, 0)
    r.add(11, "rmw_publish", A, 9, 0, 1)
    r.add(12, "callback_end", A, 100)
    for time, stamp in ((20, 1), (30, 2)):
        r.add(time, "rmw_take", A, 3, 0, stamp, 1)
        r.call(time + 1, time + 2, 5)
    r.add(40, "callback_start", A, 5, 1)
    result = r.imported(tmp_path)
    assert line(result.text, "rate") == "rate: TODO # also published outside the recording: give that a topic of its own"
    within = "'node subscription /t' takes messages within its process, for which executors call it after all other kinds"
    assert messages(result) == [within]


def test_a_callback_that_was_not_called_is_a_gap(tmp_path):
    r = Recorder(timers=2)
    r.call(100, 200)
    assert "TODO # no call of it was recorded; remove it if it is never called" in r.imported(tmp_path).text


def test_the_rate_and_its_jitter():
    """Messages at 0, 9, 20 and 30 ms: 100 Hz; the second one is 1 ms early, so that three distances of 10 ms need a jitter of 1 ms."""
    first, second = RosSubscription("/t", "n"), RosSubscription("/t", "n")
    first.stamps, second.stamps = array("q", [7, 9_000_007, 30_000_007]), array("q", [20_000_007, 30_000_007])
    found = arrivals_of([first, second])
    assert (found.rate, found.jitter, found.count) == (100, MILLISECOND, 4)
    assert arrivals_of([RosSubscription("/t", "n", stamps=array("q", [5, 5]))]) is None


def test_the_recording_of_the_tutorial_is_what_its_script_writes(tmp_path):
    robot_recording.main(tmp_path)
    files = [path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file()]
    assert len(files) == 4
    assert all((RECORDING / path).read_bytes() == (tmp_path / path).read_bytes() for path in files)


@pytest.fixture
def robot(tmp_path) -> Path:
    path = tmp_path / "robot.yaml"
    path.write_text(filled(import_recording(RECORDING).text))
    return path


def test_a_recording_is_within_the_bounds_of_its_own_description(robot):
    found = amuros.compare(robot, RECORDING, by=["analysis"])
    compared = [row for row in found.rows if row.verdict in (Agreement.WITHIN, Agreement.REFUTED)]
    assert {row.verdict for row in compared} == {Agreement.WITHIN}
    assert {row.object for row in compared} == {
        *("planner timer 20 ms", "planner subscription /odom", "logger subscription /log", "/log -> logger")
    }
    # Response time of the logger: that of the analysis; plus 500 us for the topic.
    worst = amuros.analyze(robot).host["log"].handles["logger subscription /log"].response.worst
    latency = next(row for row in compared if row.object == "/log -> logger" and row.statistic == "max")
    assert latency.predicted == worst + MILLISECOND // 2


@pytest.mark.parametrize("seed", [2, 3, 4])
def test_every_recording_is_within_the_bounds_of_its_own_description(tmp_path, seed):
    """Messages are published 0 to 3 ms after a grid and arrive at once: 10 ms are more than the jitter of any rate that fits them."""
    robot_recording.main(tmp_path / "trace", seed)
    text = filled(import_recording(tmp_path / "trace").text).replace("jitter: 3 ms", "jitter: 10 ms")
    (tmp_path / "robot.yaml").write_text(text)
    rows = amuros.compare(tmp_path / "robot.yaml", tmp_path / "trace", by=["analysis"]).rows
    compared = [row for row in rows if row.statistic is not None]
    assert len(compared) > 10
    assert {row.verdict for row in compared} == {Agreement.WITHIN}


def test_what_is_beyond_the_bounds_refutes_the_description(robot):
    robot.write_text(robot.read_text().replace("{min: 1.019 ms, max: 2.912 ms}", "1 ms"))
    found = amuros.compare(robot, RECORDING, by=["analysis"])
    refuted = {(row.object, row.quantity) for row in found.rows if row.verdict is Agreement.REFUTED}
    assert ("planner timer 20 ms", "net_execution_time") in refuted
    assert "CMP001" in {finding.rule for finding in found.findings}


def test_a_callback_that_is_not_recorded_is_not_measured(robot):
    robot.write_text(robot.read_text().replace("planner timer 20 ms", "planner timer 30 ms"))
    rows = amuros.compare(robot, RECORDING, by=["analysis"]).rows
    assert [row.verdict for row in rows if row.object == "planner timer 30 ms"] == [Agreement.NOT_MEASURED]


def test_preemption_is_not_held_against_execution_times_if_the_scheduler_was_not_recorded(robot):
    rows = amuros.compare(robot, RECORDING / "ust", by=["analysis"]).rows
    net = [row for row in rows if row.quantity == "net_execution_time"]
    assert {row.verdict for row in net} == {Agreement.NOT_PREDICTED}
    assert {row.reason for row in net} == {"the scheduler was not recorded, so that preemption is part of it"}


def test_a_message_begins_with_its_publication(tmp_path):
    """The thread became ready at 50, published at 150, and the callback began at 400."""
    r = Recorder()
    r.w.define("sched_waking", "i", tid="int32_t")
    r.add(0, "rcl_publisher_init", A, 8, 9, 1, "/t", 10)
    r.add(0, "rcl_subscription_init", A, 2, 3, 1, "/t", 10)
    r.add(0, "rclcpp_subscription_init", A, 2, 4)
    r.add(0, "rclcpp_subscription_callback_added", A, 4, 5)
    r.kernel.append(r.w.event(T + 50, "sched_waking", (0, 0, ""), 10))
    r.switch(60, 0, 10)
    r.add(100, "callback_start", A, 100, 0)
    r.add(150, "rmw_publish", A, 9, 0, 1111)
    r.add(200, "callback_end", A, 100)
    r.add(390, "rmw_take", A, 3, 0, 1111, 1)
    r.call(400, 500, 5)
    r.imported(tmp_path)
    series = amuros.measure(tmp_path / "trace").series
    (latency,) = [each for each in series if (each.name, each.quantity) == ("/t -> node", "reduced_data_age")]
    assert (latency.begin, latency.statistics.max) == ("first step", 250_000)


@pytest.mark.parametrize("events", [[], [("rcl_node_init", 1, 0, "node", "/")]], ids=["nothing", "no call"])
def test_a_recording_without_callbacks_is_refused(tmp_path, events):
    r = Recorder(timers=0)
    for name, *values in events:
        r.add(1, name, A, *values)
    with pytest.raises(InvalidArgumentError, match="no callbacks of ROS 2"):
        r.imported(tmp_path)


def test_recordings_of_several_computers_are_refused(tmp_path):
    for name in ("pc", "other"):
        r = Recorder()
        r.w.metadata = r.w.metadata.replace('"pc"', f'"{name}"')
        r.call(100, 200)
        r.write(tmp_path / "trace" / name)
    with pytest.raises(InvalidArgumentError, match="several computers, 'other', 'pc'"):
        import_recording(tmp_path / "trace")


def test_the_command(tmp_path):
    target = tmp_path / "robot.yaml"
    run = command("import", RECORDING, "-o", target)
    assert (run.returncode, run.stdout) == (0, f"{target}: written, with 10 gaps to fill (TODO)\n")
    assert target.read_text() == import_recording(RECORDING).text
    assert command("import", RECORDING, "--board", "esp32").returncode == 2


def test_a_folder_with_another_file_called_metadata_is_source_code(tmp_path):
    (tmp_path / "metadata").write_text("author: someone")
    run = command("import", tmp_path, "-o", tmp_path / "app.yaml")
    assert "there is no source code" in run.stderr


@settings(max_examples=25)
@given(st.lists(st.tuples(st.floats(0, 1), st.binary(max_size=8)), min_size=1, max_size=4), st.booleans())
def test_any_damage_gives_a_description_or_an_error(tmp_path_factory, places, in_metadata):
    folder = tmp_path_factory.mktemp("damaged")
    r = Recorder(timers=2)
    r.call(100, 200)
    r.call(300, 400, 101, B)
    r.write(folder / "trace")
    path = folder / "trace" / ("metadata" if in_metadata else "channel0_0")
    content = path.read_bytes()
    for place, breaker in places:
        at = int(place * len(content))
        content = content[:at] + breaker + content[at + len(breaker) :]
    path.write_bytes(content)
    with suppress(InvalidArgumentError, ReadError):
        assert import_recording(folder / "trace").text.startswith("# Imported")
