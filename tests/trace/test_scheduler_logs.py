"""Text logs of schedulers: ftrace text of NuttX, TRACE32, SystemView, Tracealyzer."""

import gzip

import pytest
from hypothesis import given
from hypothesis import strategies as st
from state_charts import check_trace
from traces import told

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.readers import BY_CONTENT, format_of, open_trace

# From the sample of the guide of NuttX, with nanoseconds and other names; a thread with a blank and one without a name.
NUTTX = """\
<noname>-1 [0] 0.000000000: sys_close()
<noname>-1 [0] 0.000000100: sched_waking: comm=my worker pid=5 target_cpu=0
<noname>-1 [0] 0.000001000: sched_switch: prev_comm=<noname> prev_pid=1 prev_state=S ==> next_comm=my worker next_pid=5
my worker-5 [0] 0.000002000: tracing_mark_write: B|5|step
my worker-5 [0] 0.000003000: irq_handler_entry: irq=11 name=timer_isr
my worker-5 [0] 0.000003500: sched_waking: comm=other pid=6 target_cpu=0
my worker-5 [0] 0.000004000: irq_handler_exit: irq=11 ret=handled
my worker-5 [0] 0.000004000: sched_switch: prev_comm=my worker prev_pid=5 prev_prio=100 prev_state=R ==> \
next_comm=other next_pid=6 next_prio=101
other-6 [0] 0.000006000: sched_switch: prev_comm=other prev_pid=6 prev_prio=101 prev_state=S ==> \
next_comm=my worker next_pid=5 next_prio=100
my worker-5 [0] 0.000007000: tracing_mark_write: E|5|step
my worker-5 [0] 0.000008000: sched_switch: prev_comm=my worker prev_pid=5 prev_prio=100 prev_state=S ==> \
next_comm=Idle Task next_pid=0 next_prio=0
"""
NUTTX_EVENTS = """\
100 activate my worker#0
1000 terminate thread 1#0
1000 start my worker#0
2000 runnable_start step#0 by my worker#0
3000 runnable_suspend step#0 by my worker#0
3000 preempt my worker#0
3000 start timer_isr#0
3500 activate other#0
4000 terminate timer_isr#0
4000 resume my worker#0
4000 runnable_resume step#0 by my worker#0
4000 runnable_suspend step#0 by my worker#0
4000 preempt my worker#0
4000 start other#0
6000 terminate other#0
6000 resume my worker#0
6000 runnable_resume step#0 by my worker#0
7000 runnable_terminate step#0 by my worker#0
8000 terminate my worker#0
"""

TRACE32 = """\
#######################################################################
# Task events trace file
# time(ns); task name; event;
#######################################################################
-1000; ; preempt;
+0; Low; activate;
+100; Low; switch;
+150; Low; start;
+300; High; activate;
+400; High; switch;
+450; High; runnablestart;
+500; isr_timer; isrstart;
+600; isr_timer; isrend;
+700; High; runnablestop;
+800; High; terminate;
+850; Low; switch;
+900; Low; wait;
+950; NO_TASK; switch;
+990; Low; release;
"""
# The runnable of this file has the name of its task.
TRACE32_EVENTS = """\
1000 activate Low#0
1100 start Low#0
1300 activate High#0
1400 preempt Low#0
1400 start High#0
1450 runnable_start High#0 by High#0
1500 runnable_suspend High#0 by High#0
1500 preempt High#0
1500 start isr_timer#0
1600 terminate isr_timer#0
1600 resume High#0
1600 runnable_resume High#0 by High#0
1700 runnable_terminate High#0 by High#0
1800 terminate High#0
1850 resume Low#0
1900 wait Low#0
1990 release Low#0
"""

SYSTEMVIEW = """\
"#","Time","Context","Event","Detail"
"0","0.000 000 000","Idle","Trace Start",""
"1","0.000 001 000","ISR 15","ISR Enter","Runs for 2.000 us"
"2","0.000 002 000","ISR 15","Task Ready","Sensor, runs after 771.063 us"
"3","0.000 003 000","ISR 15","ISR Exit","Returns to Scheduler"
"4","0.000 004 000","Sensor","Task Run","Runs for 10 us"
"5","0.000 005 000","Sensor","Start Marker 0x1",""
"6","0.000 007 000","Sensor","Stop Marker 0x1",""
"7","0.000 010 000","Sensor","Task Block","Sensor, blocked"
"8","0.000 011 000","Idle","System Idle",""
"9","0.000 020 000","Idle","Overflow","*** OVERFLOW *** 12 packets"
"10","0.000 030 000","Sensor","Task Run","Runs for 1 us"
"""
SYSTEMVIEW_EVENTS = """\
1000 start ISR 15#0
2000 activate Sensor#0
3000 terminate ISR 15#0
4000 start Sensor#0
5000 runnable_start Marker 0x1#0 by Sensor#0
7000 runnable_terminate Marker 0x1#0 by Sensor#0
11000 terminate Sensor#0
20000 gap
30000 resume Sensor#1
"""

TRACEALYZER = """\
Timestamp (us);Actor;Event Text
1;IDLE;Actor Ready: Control
2,5;Control;Context switch on CPU 0 to Control
3;Control;[main] B|step
4;Control;[main] E|step
5;Control;Context switch on CPU 0 to IDLE
9;IDLE;Actor Ready: Control
"""
# Without a word why it leaves the core, that it becomes ready again shows that it had blocked.
TRACEALYZER_EVENTS = """\
1000 activate Control#0
2500 start Control#0
3000 runnable_start main step#0 by Control#0
4000 runnable_terminate main step#0 by Control#0
5000 terminate Control#0
9000 activate Control#1
"""

#: The logs and their events.
KNOWN = {
    "ftrace text (NuttX)": (NUTTX, NUTTX_EVENTS),
    "TRACE32 task events": (TRACE32, TRACE32_EVENTS),
    "SystemView CSV": (SYSTEMVIEW, SYSTEMVIEW_EVENTS),
    "Tracealyzer CSV": (TRACEALYZER, TRACEALYZER_EVENTS),
}
LOGS = {name: log for name, (log, _) in KNOWN.items()}
EVENTS = {name: events.splitlines() for name, (_, events) in KNOWN.items()}


@pytest.fixture
def write(tmp_path):
    def write(text):
        path = tmp_path / "run.txt"
        path.write_text(text)
        return path

    return write


@pytest.mark.parametrize("name", LOGS)
@pytest.mark.parametrize("suffix", ["txt", "csv", "txt.gz"])
def test_what_becomes_of_the_events(tmp_path, name, suffix):
    path = tmp_path / f"run.{suffix}"
    path.write_bytes(gzip.compress(LOGS[name].encode()) if suffix.endswith("gz") else LOGS[name].encode())
    assert format_of(path).name == name
    reader = open_trace(path)
    assert told(reader) == EVENTS[name]
    # Nothing is wrong but the loss that a recorder states, and the states follow each other as BTF wants it.
    assert [finding.rule for finding in check_trace(path)] == (["TRC022"] if "OVERFLOW" in LOGS[name] else [])


def test_threads_of_the_same_name_are_kept_apart(write):
    lines = [f"a-{pid} [0] 0.00000{pid}000: sched_waking: comm=a pid={pid} target_cpu=0" for pid in (1, 2)]
    assert told(open_trace(write("\n".join(lines)))) == ["1000 activate a#0", "2000 activate a (2)#0"]


def test_a_loss_that_ftrace_states_drops_what_is_open(write):
    switch = "a-1 [0] 0.00000{}000: sched_switch: prev_comm={} prev_pid={} prev_state=S ==> next_comm={} next_pid={}\n"
    first, second = switch.format(1, "Idle Task", 0, "a", 1), switch.format(5, "a", 1, "Idle Task", 0)
    reader = open_trace(write(f"{first}CPU:0 [LOST 7 EVENTS]\n{second}"))
    tables = list(reader)
    assert told(tables) == ["1000 resume a#0", "1000 gap", "5000 terminate a#1"]
    assert tables[0].note.max() == 7
    assert [finding.rule for finding in reader.findings] == ["TRC022"]


def test_a_thread_that_leaves_another_core_than_it_entered_is_a_loss(write):
    switch = "a-1 [0] 0.00000{}000: sched_switch: prev_comm={} prev_pid={} prev_state=R ==> next_comm={} next_pid={}\n"
    reader = open_trace(write(switch.format(1, "a", 1, "b", 2) + switch.format(2, "c", 3, "a", 1)))
    assert told(reader) == ["1000 preempt a#0", "1000 resume b#0", "2000 gap", "2000 preempt c#0", "2000 resume a#1"]
    assert [finding.rule for finding in reader.findings] == ["TRC021"]


def test_a_thread_that_blocks_in_a_runnable_waits(write):
    events = ["A; activate", "A; switch", "step; runnablestart", "A; wait", "A; release", "A; switch", "step; runnablestop"]
    assert told(open_trace(write("".join(f"+{time}; {event};\n" for time, event in enumerate(events))))) == [
        *("0 activate A#0", "1 start A#0", "2 runnable_start step#0 by A#0"),
        *("3 runnable_suspend step#0 by A#0", "3 wait A#0"),
        *("4 release A#0", "5 resume A#0", "5 runnable_resume step#0 by A#0", "6 runnable_terminate step#0 by A#0"),
    ]


@pytest.mark.parametrize(
    ("name", "line", "rule"),
    [
        ("ftrace text (NuttX)", "what is this", "TRC002"),
        ("ftrace text (NuttX)", "a-1 [0] 1.0: mystery: x=1", "TRC003"),
        ("ftrace text (NuttX)", "a-1 [0] 0.0: sched_waking: comm=a pid=1", "TRC004"),
        ("ftrace text (NuttX)", "a-1 [0] 1.0: irq_handler_exit: irq=3 ret=handled", "TRC021"),
        ("TRACE32 task events", "+99999; A", "TRC002"),
        ("TRACE32 task events", "+99999; A; dance;", "TRC003"),
        ("TRACE32 task events", "-5000; A; activate;", "TRC004"),
        ("SystemView CSV", '"11","soon","Sensor","Task Run",""', "TRC002"),
        ("SystemView CSV", '"11","0.001","Sensor"', "TRC002"),
        ("SystemView CSV", '"11","0.001","Sensor","Task Ready",""', "TRC002"),
        ("SystemView CSV", '"11","0.001","Sensor","Dance",""', "TRC003"),
        ("Tracealyzer CSV", "99;A;something else", "TRC003"),
    ],
)
def test_a_line_that_cannot_be_used_is_reported_and_the_others_are_read(write, name, line, rule):
    path = write(LOGS[name] + line + "\n")
    reader = open_trace(path)
    lines = told(reader)
    assert lines[: len(EVENTS[name])] == EVENTS[name]
    # A line that may have been an event is a loss, over which nothing goes on.
    assert [line.split()[1] for line in lines[len(EVENTS[name]) :]] == (["gap"] if rule in ("TRC002", "TRC004") else [])
    assert rule in [finding.rule for finding in reader.findings]


def test_a_text_that_is_none_of_these(write):
    assert format_of(write("hello\n")) is None
    with pytest.raises(InvalidArgumentError, match=r"TRACE32 task events"):
        open_trace(write("hello\n"))


@pytest.mark.parametrize("name", [known.name for known in BY_CONTENT])
@given(
    lines=st.lists(st.integers(0, 12)),
    places=st.lists(st.tuples(st.floats(0, 1), st.binary(max_size=30), st.integers(0, 40)), max_size=4),
)
def test_a_damaged_log(tmp_path_factory, name, lines, places):
    path = tmp_path_factory.mktemp("logs") / "run.csv"
    known = LOGS[name].encode().splitlines(keepends=True)
    content = b"".join(known + [known[number % len(known)] for number in lines])
    for place, breaker, length in places:
        at = int(place * len(content))
        content = content[:at] + breaker + content[at + length :]
    path.write_bytes(content)
    reader = open_trace(path)
    times = [int(time) for table in reader for time in table.time]
    assert times == sorted(times)
    check_trace(path)
