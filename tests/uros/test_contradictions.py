"""Contradictions in an app.yaml whose values are all valid."""

from operator import itemgetter

import pytest
import yaml
from support import ROOT

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
    "row", yaml.safe_load((ROOT / "tests" / "uros" / "contradictions.yaml").read_text()), ids=itemgetter("message")
)
def test_a_contradiction_with_its_location(author, row):
    assert APP.count(row["change"]) == 1
    findings = author.findings(APP.replace(row["change"], row["to"]))
    assert any((line, rule) == (row["line"], row["rule"]) and row["message"] in text for line, rule, text in findings), findings


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
