"""Contradictions in an app.yaml whose values are all valid."""

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
        ("single-core,", "singel-core,", 3, "APP001", "unknown platform 'singel-core'"),
        ("single-core,", "./none.yaml,", 3, "APP001", "platform file"),
        ("platform: single-core, ", "", 3, "APP005", "the frequency of core 'Core_0' is unknown"),
        ("cores: 2", "cores: [A, A]", 3, "APP002", "duplicate core name 'A' (first defined on line 3)"),
        ("cores: 2", "memories: [{name: M, size: 1 B}, {name: M, size: 1 B}]", 3, "APP002", "duplicate memory name 'M'"),
        ("cores: 2", "label_memory: M", 3, "APP001", "undefined memory 'M'"),
        ("name: Timer", "name: Sub", 13, "APP002", "duplicate process name 'Sub' (first defined on line 11)"),
        ("name: Plain", "name: Timer", 15, "APP002", "duplicate process name 'Timer'"),
        ("rate: 50 Hz, ", "", 13, "APP003", "'Sub' has neither 'interval' nor 'rate'"),
        ("rate: 50 Hz", "rate: 50 Hz, interval: 10 ms", 13, "APP003", "'interval' and 'rate' of 'Sub' contradict each other"),
        ("writes: [speed]", "publishes: [aut]", 11, "APP001", "undefined publisher 'aut' in node 'node'"),
        ("writes: [speed]", "requests: [x]", 11, "APP001", "undefined client 'x' in node 'node'"),
        ("name: node", "name: node\n      core: Core_2", 9, "APP001", "undefined core 'Core_2'"),
        ("name: Plain, ", "name: Plain, core: Core_2, ", 15, "APP001", "undefined core 'Core_2'"),
        ("period: 10 ms, ", "", 15, "APP003", "'Plain' has no activation"),
        ("period: 10 ms, ", "period: ~, ", 15, "YML012", "period: no value is given"),
        (
            "period: 10 ms, ",
            "period: 10 ms, sporadic: 5 ms, ",
            15,
            "APP003",
            "more than one activation: 'period' and 'sporadic'",
        ),
        ("period: 10 ms, ", "once: 10 ms, offset: 1 ms, ", 15, "APP003", "'offset' of 'Plain' has no effect without 'period'"),
        ("period: 10 ms, ", "sporadic: {min: 5 ms, max: 4 ms}, ", 15, "APP003", "'min' (5 ms) is greater than 'max' (4 ms)"),
        (
            "period: 10 ms, ",
            "burst: {period: 10 ms, count: 3, distance: 5 ms}, ",
            15,
            "APP003",
            "(15 ms) is longer than its period (10 ms)",
        ),
        ("period: 10 ms, ", "times: {period: 10 ms, at: [5 ms, 2 ms]}, ", 15, "APP003", "must be strictly increasing"),
        (", execution_time: 1 ms}", "}", 15, "APP003", "'Plain' does nothing"),
        (", execution_time: 1 ms}", ", execution_time: 1 ms, triggers: [Plan]}", 15, "APP001", "undefined task 'Plan'"),
        (
            "execution_time: 1 ms}",
            "reads: [a], runnables: [{name: R}]}",
            15,
            "APP003",
            "so 'reads' must be set for one of them",
        ),
        (
            "execution_time: 1 ms}",
            "runnables: [{name: R}, {name: R, reads: [a]}]}",
            15,
            "APP002",
            "runnable 'R' is defined twice with different contents (first defined on line 15)",
        ),
        (
            "execution_time: 1 ms}",
            "runnables: [{name: Timer_Callback}]}",
            15,
            "APP002",
            "has the name of a runnable of the middleware",
        ),
        ("Executor_Task, Sub]", "Executor_Tusk, Sub]", 17, "APP001", "undefined process, runnable or label 'Executor_Tusk'"),
        ("Executor_Task, Sub]", "Timer, Sub, Timer]", 17, "APP004", "'Timer' occurs twice in the path"),
        (
            "Executor_Task, Sub]",
            "speed, Timer]",
            17,
            "APP004",
            "'speed' is a label without a process or runnable before it that writes it",
        ),
        ("Executor_Task, Sub]", "Timer], to: start", 17, "APP004", "starts and ends with the same event 'Timer_start'"),
        ("path: [Executor_Task, Sub]", "sequence: [chain]", 17, "APP004", "contains itself: chain -> chain"),
        ("path: [Executor_Task, Sub]", "sequence: [other]", 17, "APP001", "undefined chain 'other'"),
        ("path: [Executor_Task, Sub]", "parallel: [[Timer, Sub], [Timer, Sub]]", 17, "APP004", "other elements in between"),
        ("process: Timer", "process: Timr", 19, "APP001", "undefined process or runnable 'Timr'"),
    ],
)
def test_a_contradiction_with_its_location(author, old, new, line, rule, message):
    assert APP.count(old) == 1
    findings = author.findings(APP.replace(old, new))
    assert any((line, rule) == found[:2] and message in found[2] for found in findings), findings


def test_the_unchanged_description_is_valid(author):
    assert author.describe(APP).findings == ()


def test_a_description_without_processes(author):
    text = "amuros: 1\nname: app\nhardware: {platform: generic}\n"
    assert author.findings(text) == [(1, "APP009", "no callback, task or interrupt service routine is defined")]


def test_a_cycle_of_chains(author):
    text = APP.replace(
        "path: [Executor_Task, Sub]}", "sequence: [b]}\n  - {name: b, sequence: [c]}\n  - {name: c, sequence: [chain]}"
    )
    assert author.findings(text) == [(19, "APP004", "chain 'chain' contains itself: chain -> b -> c -> chain")]


def test_chains_that_do_not_fit_together(author):
    text = APP.replace(
        "path: [Executor_Task, Sub]}",
        "path: [Timer, Sub]}\n  - {name: b, path: [Sub, Plain]}\n  - {name: c, sequence: [chain, b]}",
    )
    assert author.findings(text) == [(19, "APP004", "'b' starts with 'Sub_start', but 'chain' ends with 'Sub_finish'")]


def test_a_link_without_data_flow_or_trigger(author):
    findings = author.describe(APP.replace("Executor_Task, Sub]", "Timer, Sub, Plain]")).findings
    assert [(f.rule, f.location.line, f.message) for f in findings if f.rule == "UR130"] == [
        ("UR130", 17, "no data flow or trigger connects 'Sub' to 'Plain'")
    ]


def test_a_misspelled_label(author):
    findings = author.describe(APP.replace("reads: [speed]", "reads: [sped]")).findings
    assert any(
        "label 'sped' is read but never written, and 'speed' is written but never read" in finding.message
        for finding in findings
    )


def test_an_overloaded_bus(author):
    findings = author.describe(APP.replace("executor:", "transport: {can: {bitrate: 10 kbit/s}}\n  executor:")).findings
    # Three frames of 135 bits every 20 ms.
    assert any(f.rule == "UR131" and "up to 202.5 % of the CAN bus" in f.message for f in findings)


def test_a_misspelled_platform_does_not_hide_what_else_is_wrong(author):
    text = APP.replace("single-core,", "singel-core,").replace("process: Timer", "process: Timr")
    assert [(line, message) for line, _, message in author.findings(text)] == [
        (3, "unknown platform 'singel-core'"),
        (19, "undefined process or runnable 'Timr'"),
    ]


def test_a_platform_that_is_not_recognised_has_no_consequences(author):
    text = APP.replace("single-core,", "tricore,").replace("execution_time: 1 ms}", "execution_time: {on: {tricore: 1 ms}}}")
    assert [(line, message) for line, _, message in author.findings(text)] == [(3, "unknown platform 'tricore'")]
