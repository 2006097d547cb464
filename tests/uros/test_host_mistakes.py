"""Mistakes in a host that are valid descriptions: each has a finding with its line and a remedy."""

import pytest
from support import ROOT

from amalthea_uros.errors import ReadError
from amalthea_uros.uros.described import describe_text

ROBOT = (ROOT / "samples" / "robot-with-host.yaml").read_text()
MISTAKES = [
    (
        "topic: odom, depth",
        "topic: odometry, depth",
        "HST005",
        "nothing publishes 'odometry', to which 'On_Odom' subscribes",
        "'odom'",
    ),
    ("topic: pose, latency", "topic: poze, latency", "APP001", "undefined topic 'poze'", "'pose'"),
    ("publishes: [pose, log]", "publishes: [pose, log, log]", "APP003", "'On_Odom' has 'log' more than once", "once"),
    (
        "{name: log, type: events,",
        "{name: spare}\n    - {name: log, type: events,",
        "HST005",
        "no node is in the executor 'spare'",
        "node",
    ),
    (
        "priority: 20, core",
        "priority: 80, core",
        "HST005",
        "'control' and 'log' have the same priority 80 on core 0",
        "different",
    ),
    ("[{name: images}]", "[{name: images}, {name: spare}]", "HST005", "no callback is in the group 'spare'", "'group'"),
    (
        "max: 3 ms}}",
        "max: 3 ms}, reads: [map]}",
        "HST005",
        "no callback of the host writes 'map', which 'Watch' reads",
        "no variable",
    ),
    (
        "max: 3 ms}}",
        "max: 3 ms}, group: slow}\n      groups: [{name: slow, type: reentrant}]",
        "HST005",
        "callbacks of the group 'slow' cannot overlap: 'control' has one thread",
        "multi-threaded",
    ),
    (
        "thread: {policy: fifo, priority: 80",
        "thread: {priority: 80",
        "YML012",
        "'other' has no 'priority'; set 'policy: fifo'",
        "",
    ),
]


def findings(text):
    try:
        return describe_text(text).assembly.findings
    except ReadError as error:
        return error.findings


def test_the_sample_has_none_of_them():
    assert findings(ROBOT) == ()


@pytest.mark.parametrize(("old", "new", "rule", "message", "remedy"), MISTAKES)
def test_a_mistake_has_a_finding_with_its_line_and_a_remedy(old, new, rule, message, remedy):
    assert ROBOT.count(old) == 1
    text = ROBOT.replace(old, new)
    found = next(each for each in findings(text) if each.rule == rule and message in each.message)
    line = text.splitlines()[found.location.line - 1]
    assert line not in ROBOT.splitlines() or "80 on core" in message
    assert remedy in found.help
