"""The host of an app.yaml: what it becomes, what it is analysed with, and what is refused."""

import re
from pathlib import Path

import pytest
from support import ROOT

from amalthea_uros import analyze, describe, simulate
from amalthea_uros.bridge.build import build_model
from amalthea_uros.bridge.extract import extract
from amalthea_uros.errors import ReadError
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import parse_time
from amalthea_uros.uros.described import describe_text
from amalthea_uros.xmi.load import load
from amalthea_uros.xmi.save import save

PAGE = (ROOT / "docs" / "ros2-host.md").read_text()
ROBOT = re.search(r'```yaml title="robot.yaml"\n(.*?)```', PAGE, re.DOTALL)[1]


def responses(text):
    """The executors of the host in a text."""
    return analyze(text).host


def worst(text, executor, callback):
    return responses(text)[executor].handles[callback].response.worst


def test_callbacks_are_in_the_order_of_the_file_with_timers_first():
    control, log = describe_text(ROBOT).assembly.system.host.executors
    assert [(each.name, each.kind) for each in control.callbacks] == [
        ("Watch", HandleKind.TIMER),
        ("On_Odom", HandleKind.SUBSCRIPTION),
    ]
    assert [each.depth for each in (*control.callbacks, *log.callbacks)] == [10, 5, 10]


def test_a_host_comes_back_from_a_model(tmp_path):
    system = describe_text(ROBOT.replace("cores: 4}", "cores: 4, isolated: [3]}")).assembly.system
    save(build_model(system), tmp_path / "robot.amxmi")
    found = extract(load(tmp_path / "robot.amxmi"))
    assert found.system == system
    assert found.findings == ()
    assert analyze(tmp_path / "robot.amxmi").chains["odom-to-cmd"].worst == analyze(ROBOT).chains["odom-to-cmd"].worst


def test_threads_of_higher_priority_delay_the_others():
    assert worst(ROBOT, "control", "On_Odom") == parse_time("3.8 ms")  # after Watch, which has just begun
    assert worst(ROBOT, "log", "On_Log") == parse_time("4.8 ms")  # after Watch and On_Odom
    alone = ROBOT.replace("priority: 20, core: 0", "priority: 20, core: 1")
    assert worst(alone, "log", "On_Log") == parse_time("1 ms")


def test_a_reservation_provides_its_budget_after_twice_the_rest_of_a_period():
    reserved = ROBOT.replace("{policy: fifo, priority: 20, core: 0}", "{policy: deadline, budget: 2 ms, period: 10 ms}")
    assert worst(reserved, "log", "On_Log") == parse_time("17 ms")
    # The other thread is preempted by two budgets, at the end of a period and at the begin of the next one.
    assert worst(reserved, "control", "On_Odom") == parse_time("7.8 ms")


def test_the_only_thread_of_sched_other_of_an_isolated_core_waits_for_those_of_sched_fifo():
    """As one of the lowest priority; on a core that is not isolated, or with another such thread, anything can delay it."""
    isolated = ROBOT.replace("cores: 4}", "cores: 4, isolated: [0, 1]}")
    other = "{policy: fifo, priority: 20, core: 0}", "{core: 0}"
    assert worst(isolated.replace(*other), "log", "On_Log") == parse_time("4.8 ms")
    assert worst(isolated.replace(other[0], "{core: 1}"), "log", "On_Log") == parse_time("1 ms")
    assert worst(isolated.replace(other[0], "{core: 2}"), "log", "On_Log") is None
    for shared in ("{core: 1}", "{}"):
        both = isolated.replace(other[0], "{core: 1}").replace("{policy: fifo, priority: 80, core: 0}", shared)
        assert worst(both, "log", "On_Log") is None
    threads = isolated.replace(
        "{name: log, thread: {policy: fifo, priority: 20", "{name: log, type: multi-threaded, threads: 2, thread: {"
    )
    assert worst(threads.replace("thread: {, core", "thread: {core"), "log", "On_Log") is None


@pytest.mark.parametrize(
    ("cores", "worst_of_log"), [(("", ""), "17 ms"), ((", core: 0", ", core: 1"), "17 ms"), ((", core: 0", ", core: 0"), None)]
)
def test_reservations_on_one_core_have_to_fit_on_it(cores, worst_of_log):
    """Each of 2 ms in 10 ms and 9 ms in 10 ms has a core of its own of the four, or they are stated to share one."""
    log, control = (
        f"{{policy: deadline, budget: {budget} ms, period: 10 ms{core}}}" for budget, core in zip((2, 9), cores, strict=True)
    )
    text = ROBOT.replace("{policy: fifo, priority: 20, core: 0}", log).replace("{policy: fifo, priority: 80, core: 0}", control)
    assert worst(text, "log", "On_Log") == (None if worst_of_log is None else parse_time(worst_of_log))


@pytest.mark.parametrize(("others", "worst_of_log"), [(4, "17 ms"), (6, "17 ms"), (8, None)])
def test_more_reservations_than_cores_keep_their_deadlines_under_a_bound_of_their_shares(others, worst_of_log):
    """Two cores guarantee 2 - 0.6 for 0.2 + 2 x 0.6, but only 2 - 0.8 for 0.2 + 2 x 0.8 (Goossens, Funk, Baruah 2003)."""
    log, control = (f"{{policy: deadline, budget: {budget} ms, period: 10 ms, cores: [0, 1]}}" for budget in (2, others))
    text = ROBOT.replace("{policy: fifo, priority: 20, core: 0}", log).replace("{policy: fifo, priority: 80, core: 0}", control)
    text = text.replace("    - {name: log,", f"    - {{name: third, thread: {control}}}\n    - {{name: log,")
    assert worst(text, "log", "On_Log") == (None if worst_of_log is None else parse_time(worst_of_log))


def test_each_thread_of_a_multi_threaded_executor_has_a_reservation_of_its_own():
    """Both can take the core from the other executor, each twice in a row: 3.8 ms and two times two budgets of 1 ms."""
    log = "{name: log, type: multi-threaded, threads: 2, thread: {policy: deadline, budget: 1 ms, period: 20 ms}"
    text = ROBOT.replace("{name: log, thread: {policy: fifo, priority: 20, core: 0}", log)
    assert worst(text, "control", "On_Odom") == parse_time("7.8 ms")


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("thread: {policy: fifo, priority: 80, core: 0}", "thread: {core: 0}", "'other'"),
        ("priority: 80, core: 0", "priority: 80", "several cores"),
        ("  latency: {min: 50 us, max: 400 us}\n", "", "latency of the topic 'odom'"),
        ("to_host: {min: 0.2 ms, max: 2 ms}, ", "", "'to_host' of the agent is not stated"),
        ("topic: odom, depth", "topic: scan, depth", "publishes 'scan'"),
        ("{min: 1 ms, max: 3 ms}", "30 ms", "overload"),
        (
            "control, thread: {policy: fifo, priority: 80,",
            "control, type: multi-threaded, threads: 2, thread: {policy: deadline, budget: 5 ms, period: 10 ms,",
            "a thread of 'control' that has used its budget up can hold up the others",
        ),
        (
            "{policy: fifo, priority: 80, core: 0}}\n    - {name: log, thread: {policy: fifo, priority: 20, core: 0}",
            "{policy: deadline, budget: 6 ms, period: 10 ms, core: 0}}\n"
            "    - {name: log, thread: {policy: deadline, budget: 5 ms, period: 10 ms, core: 0}",
            "those on its cores need 1.1 cores, and global EDF guarantees no more than 1",
        ),
        (
            "{policy: fifo, priority: 80, core: 0}}\n    - {name: log, thread: {policy: fifo, priority: 20, core: 0}",
            "{policy: deadline, budget: 3 ms, period: 10 ms, cores: [0, 1]}}\n"
            "    - {name: log, thread: {policy: deadline, budget: 3 ms, period: 10 ms, core: 0}",
            "shares some of its cores",
        ),
    ],
)
def test_what_is_not_stated_leaves_the_executor_unknown(old, new, reason):
    assert old in ROBOT
    control = responses(ROBOT.replace(old, new))["control"]
    assert reason in control.reason
    assert all(handle.response.worst is None for handle in control.handles)
    assert analyze(ROBOT.replace(old, new)).chains["odom-to-cmd"].worst is None


def test_the_controller_is_analysed_with_the_jitter_of_the_host():
    """Report (14.086284724 ms), the wire (0.716145835 ms), the agent (1.8 ms), two topics (0.35 ms each), and On_Odom (3.6 ms) vary."""
    result = analyze(ROBOT.replace("jitter: 25 ms", "jitter: 1 ms"))
    (handle,) = (each for each in result.solution.context.system.executors[0].handles if each.name == "On_Cmd")
    published = result.solution.event_models["odom_topic_from_Report"].jitter
    assert handle.jitter == published + parse_time("716145.835 ns") + parse_time("6.1 ms")
    assert [each.rule for each in result.findings if each.rule.startswith("HST")] == ["HST003"]
    assert result.chains["odom-to-cmd"].worst is not None


UNLIKE = [
    ("max: 3 ms}}", "max: 3 ms}, publishes: [cmd_vel]}", "HST004"),  # several publishers
    ("interval: 100 ms", "interval: 200 ms", "HST003"),
    ("policy: fifo, priority: 80, core: 0", "core: 0", "HST001"),  # it is unknown when the host publishes
]


@pytest.mark.parametrize(("old", "new", "rule"), UNLIKE)
def test_nothing_is_met_that_depends_on_messages_that_the_host_sends_otherwise(old, new, rule):
    text = ROBOT.replace("execution_time: 150 us}", "execution_time: 150 us, deadline: 60 ms}").replace(old, new)
    result = analyze(text)
    assert rule in {each.rule for each in result.findings}
    assert result.chains["odom-to-cmd"].worst is None
    judged = (*result.requirements, result.processes["cmd_vel_topic_to_On_Cmd"])
    assert {each.name for each in judged} >= {"On_Cmd_deadline", "odom-to-cmd_reaction"}
    assert {each.verdict for each in judged} == {Verdict.UNKNOWN}
    assert result.summary.schedulable is Schedulable.UNKNOWN


@pytest.mark.parametrize(("old", "new", "_rule"), UNLIKE)
def test_a_callback_outside_of_loops_is_unknown_with_the_task_that_takes_its_messages(old, new, _rule):
    loop = "loop: {spin_some: 100 ms, sleep: 10 ms}, execution_time: {base: 40 us, per_handle: 5 us}"
    text = ROBOT.replace(loop, "period: 10 ms, execution_time: 10 us").replace(old, new)
    assert {analyze(text).processes[each].verdict for each in ("Spin", "On_Cmd")} == {Verdict.UNKNOWN}


@pytest.mark.parametrize("executor", ["log", "control"])
def test_callbacks_that_publish_in_a_circle_are_unknown(executor):
    text = ROBOT.replace("execution_time: {min: 200 us, max: 1 ms}}", "execution_time: 1 ms, publishes: [odom2]}").replace(
        "executor: log", f"executor: {executor}"
    )
    results = responses(text.replace("topic: odom, depth", "topic: odom2, depth"))
    assert "circle" in results["control"].reason
    assert results["control"].handles["On_Odom"].response.worst is None


def test_a_timer_that_reads_what_a_callback_writes_adds_its_period():
    text = ROBOT.replace("publishes: [cmd_vel, log]", "writes: [pose], publishes: [log]")
    text = text.replace("max: 3 ms}}", "max: 3 ms}, reads: [pose], publishes: [cmd_vel]}")
    text = text.replace("On_Odom, /cmd_vel", "On_Odom, Watch, /cmd_vel").replace(
        "interval: 100 ms, jitter: 25 ms", "interval: 20 ms"
    )
    hops = {hop.name: hop.worst for hop in analyze(text).chains["odom-to-cmd"].hops}
    assert hops["control: Watch"] == parse_time("20 ms") + parse_time("3.8 ms")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("executor: log", "executor: lag", "undefined executor of the host 'lag'"),
        ("core: 0}}\n    - {name: log", "core: 4}}\n    - {name: log", "'control' runs on core 4"),
        ("cores: 4}", "cores: 4, isolated: [0, 4]}", "'pc' has no core 4"),
        ("name: On_Log, topic", "name: On_Odom, topic", "duplicate callback of the host name 'On_Odom'"),
        ("On_Odom, topic: odom", "On_Odom, group: g, topic: odom", "undefined callback group 'g'"),
        ("chains:", "  topics: [{topic: odom, rate: 10 Hz}]\nchains:", "the rate of 'odom' is stated, but follows"),
        ("policy: fifo, priority: 20", "policy: fifo", "needs 'priority'"),
        ("{name: log, thread", "{name: log, type: multi-threaded, thread", "needs 'threads'"),
        ("/odom, On_Odom", "/odom, On_Odum", "undefined process, runnable or label 'On_Odum'"),
    ],
)
def test_contradictions_are_refused_with_their_place(old, new, message):
    assert old in ROBOT
    with pytest.raises(ReadError) as refused:
        describe_text(ROBOT.replace(old, new, 1))
    (finding,) = (each for each in refused.value.findings if message in each.message)
    assert finding.location.line


def test_a_host_can_be_described_without_callbacks_of_a_controller(tmp_path):
    text = ROBOT[: ROBOT.index("middleware:")] + ROBOT[ROBOT.index("\nhost:") + 1 : ROBOT.index("chains:")]
    path = Path(tmp_path, "host.yaml")
    path.write_text(
        text.replace(
            "      subscriptions:\n        - {name: On_Odom, topic: odom",
            "      subscriptions:\n        - {name: On_Odom, topic: scan",
        )
    )
    assert len(describe(path).system.host.executors) == 2


SERVICES = """
amuros: 1
name: services
hardware: {platform: host}
host:
  ros: humble
  computers: [{name: pc, cores: 2}]
  latency: 0 ms
  executors:
    - {name: E, thread: {policy: fifo, priority: 1, core: 0}}
    - {name: F, thread: {policy: fifo, priority: 1, core: 1}}
  nodes:
    - name: user
      executor: E
      timers: [{name: Ask, period: 100 ms, execution_time: 3 ms, calls: [plan]}]
      clients: [{name: On_Plan, service: plan, execution_time: 2 ms}]
    - name: planner
      executor: F
      services: [{name: Plan, service: plan, execution_time: 20 ms}]
chains: [{name: asked, path: [Ask, Plan, On_Plan], reaction: 40 ms}]
"""


def test_requests_and_responses_of_a_service_are_messages():
    """Ask ends at 5 ms, if a response has just begun, Plan after 20 ms more, and On_Plan takes 2 ms, after 3 ms of Ask."""
    result = analyze(SERVICES)
    assert [[each.kind for each in executor.handles] for executor in result.host] == [
        [HandleKind.TIMER, HandleKind.CLIENT],
        [HandleKind.SERVICE],
    ]
    assert result.chains["asked"].worst == parse_time("5 ms") + parse_time("20 ms") + parse_time("5 ms")
    (chain,) = simulate(SERVICES, "2 s").chains
    assert chain.observations > 15
    assert chain.quantities[ChainQuantity.REDUCED_REACTION_TIME].max == parse_time("25 ms")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("calls: [plan]", "calls: [plans]", "undefined service 'plans'"),
        ("{name: On_Plan, service: plan", "{name: On_Plan, service: plane", "undefined service 'plane'"),
        ("execution_time: 20 ms}", "execution_time: 20 ms, calls: [plan]}", "is called in the nodes planner, user"),
    ],
)
def test_calls_without_a_service_and_responses_for_several_nodes_are_refused(old, new, message):
    with pytest.raises(ReadError) as refused:
        describe_text(SERVICES.replace(old, new))
    assert message in str([each.message for each in refused.value.findings])
