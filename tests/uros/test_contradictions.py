"""What an app.yaml may not say, although each value alone is sound."""

import pytest

APP = """\
amuros: 1
name: app
hardware: {platform: single-core, cores: 2}
middleware:
  executor: {period: 1 ms, execution_time: 12 us}
application:
  nodes:
    - name: node
      publishers: [{topic: out, message_size: 4 B}]
      timers:
        - {name: Timer, period: 1 ms, execution_time: 4 us, writes: [speed]}
      subscriptions:
        - {name: Sub, topic: t, message_size: 4 B, rate: 50 Hz, execution_time: 4 us, reads: [speed]}
tasks:
  - {name: Plain, period: 10 ms, execution_time: 1 ms}
chains:
  - {name: chain, path: [Executor_Task, Sub]}
requirements:
  - {process: Timer, response_time: 1 ms}
"""


@pytest.mark.parametrize(
    ("old", "new", "line", "rule", "message"),
    [
        ("single-core,", "singel-core,", 3, "APP001", "'singel-core' is not a known platform"),
        ("single-core,", "./none.yaml,", 3, "APP001", "there is no platform file"),
        ("platform: single-core, ", "", 3, "APP005", "the clock of core 'Core_0' is not known"),
        ("cores: 2", "cores: [A, A]", 3, "APP002", "there are two cores named 'A'"),
        ("cores: 2", "memories: [{name: M, size: 1 B}, {name: M, size: 1 B}]", 3, "APP002", "two memories named 'M'"),
        ("cores: 2", "label_memory: M", 3, "APP001", "there is no memory named 'M'"),
        ("name: Timer", "name: Sub", 13, "APP002", "the process name 'Sub' is used twice, the first one stands in line 11"),
        ("name: Plain", "name: Timer", 15, "APP002", "'Timer' is used twice"),
        ("rate: 50 Hz, ", "", 13, "APP003", "'Sub' has neither 'interval' nor 'rate'"),
        ("rate: 50 Hz", "rate: 50 Hz, interval: 10 ms", 13, "APP003", "'interval' and 'rate' of 'Sub' contradict each other"),
        ("writes: [speed]", "publishes: [aut]", 11, "APP001", "there is no publisher of node 'node' named 'aut'"),
        ("writes: [speed]", "requests: [x]", 11, "APP001", "there is no client of node 'node' named 'x'"),
        ("name: node", "name: node\n      core: Core_2", 9, "APP001", "there is no core named 'Core_2'"),
        ("name: Plain, ", "name: Plain, core: Core_2, ", 15, "APP001", "there is no core named 'Core_2'"),
        ("period: 10 ms, ", "", 15, "APP003", "nothing activates 'Plain'"),
        (
            "period: 10 ms, ",
            "period: 10 ms, sporadic: 5 ms, ",
            15,
            "APP003",
            "more than one activation: 'period' and 'sporadic'",
        ),
        ("period: 10 ms, ", "once: 10 ms, offset: 1 ms, ", 15, "APP003", "'offset' belongs to 'period'"),
        ("period: 10 ms, ", "sporadic: {min: 5 ms, max: 4 ms}, ", 15, "APP003", "'min' is greater than 'max'"),
        ("period: 10 ms, ", "burst: {period: 10 ms, count: 3, distance: 5 ms}, ", 15, "APP003", "longer than its period"),
        ("period: 10 ms, ", "times: {period: 10 ms, at: [5 ms, 2 ms]}, ", 15, "APP003", "have to rise"),
        (", execution_time: 1 ms}", "}", 15, "APP003", "'Plain' does nothing"),
        (", execution_time: 1 ms}", ", execution_time: 1 ms, triggers: [Plan]}", 15, "APP001", "there is no task named 'Plan'"),
        ("execution_time: 1 ms}", "reads: [a], runnables: [{name: R}]}", 15, "APP003", "'reads' belongs to one of them"),
        (
            "execution_time: 1 ms}",
            "runnables: [{name: R}, {name: R, reads: [a]}]}",
            15,
            "APP002",
            "the function 'R' is described in another way before",
        ),
        ("execution_time: 1 ms}", "runnables: [{name: Timer_Callback}]}", 15, "APP002", "belongs to the middleware"),
        ("Executor_Task, Sub]", "Executor_Tusk, Sub]", 17, "APP001", "no process, function or label named 'Executor_Tusk'"),
        ("Executor_Task, Sub]", "Timer, Sub, Timer]", 17, "APP004", "the path goes through 'Timer' twice"),
        ("Executor_Task, Sub]", "Timer, speed]", 17, "APP004", "starts and ends with a process or function"),
        ("Executor_Task, Sub]", "Timer], to: start", 17, "APP004", "starts with the event with which it ends"),
        ("path: [Executor_Task, Sub]", "sequence: [chain]", 17, "APP004", "is part of itself: chain -> chain"),
        ("path: [Executor_Task, Sub]", "sequence: [other]", 17, "APP001", "there is no chain named 'other'"),
        ("path: [Executor_Task, Sub]", "parallel: [[Timer, Sub], [Timer, Sub]]", 17, "APP004", "have others in between"),
        ("process: Timer", "process: Timr", 19, "APP001", "there is no process or function named 'Timr'"),
    ],
)
def test_a_contradiction_with_its_place(author, old, new, line, rule, message):
    assert APP.count(old) == 1
    findings = author.findings(APP.replace(old, new))
    assert any((line, rule) == found[:2] and message in found[2] for found in findings), findings


def test_the_whole_is_sound(author):
    assert author.describe(APP).findings == ()


def test_nothing_that_runs(author):
    text = "amuros: 1\nname: app\nhardware: {platform: generic}\n"
    assert author.findings(text) == [(1, "APP009", "there is nothing that runs")]


def test_circles_of_chains(author):
    text = APP.replace(
        "path: [Executor_Task, Sub]}", "sequence: [b]}\n  - {name: b, sequence: [c]}\n  - {name: c, sequence: [chain]}"
    )
    assert author.findings(text) == [(19, "APP004", "the chain 'chain' is part of itself: chain -> b -> c -> chain")]


def test_chains_that_do_not_fit_together(author):
    text = APP.replace(
        "path: [Executor_Task, Sub]}",
        "path: [Timer, Sub]}\n  - {name: b, path: [Sub, Plain]}\n  - {name: c, sequence: [chain, b]}",
    )
    assert author.findings(text) == [(19, "APP004", "'b' starts with 'Sub_start', but 'chain' ends with 'Sub_finish'")]


def test_a_hop_that_nothing_carries_is_told(author):
    findings = author.describe(APP.replace("Executor_Task, Sub]", "Timer, Sub, Plain]")).findings
    assert [(f.rule, f.location.line, f.message) for f in findings if f.rule == "UR130"] == [
        ("UR130", 17, "nothing carries the effect from 'Sub' to 'Plain'")
    ]


def test_a_label_with_a_slip_of_the_pen(author):
    findings = author.describe(APP.replace("reads: [speed]", "reads: [sped]")).findings
    assert any("nothing writes the label 'sped', and nothing reads 'speed'" in finding.message for finding in findings)


def test_a_bus_that_is_too_slow(author):
    findings = author.describe(APP.replace("executor:", "transport: {can: {bitrate: 10 kbit/s}}\n  executor:")).findings
    # Three frames of 135 bits every 20 ms.
    assert any(f.rule == "UR131" and "up to 202% of the CAN bus" in f.message for f in findings)
