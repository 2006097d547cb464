"""Executors, messages and the host in the comments of a project: the same when read, and unknown where a comment is damaged."""

import re

import pytest
from support import ROOT

from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.export import export
from amalthea_uros.services.subject import open_system

PAGE = (ROOT / "docs" / "ros2-host.md").read_text(encoding="utf-8")
ROBOT = re.search(r'```yaml title="robot.yaml"\n(.*?)```', PAGE, re.DOTALL)[1]
MESSAGE = "cmd_vel_topic_to_On_Cmd"


def project_of(text, folder):
    (folder / "robot.yaml").write_text(text)
    return export(folder / "robot.yaml", folder / "robot.iprx")


def verdicts(path):
    return {each.name: each.verdict for each in analyze_files(path).analysis.processes}


def test_the_host_is_the_same(tmp_path):
    result = project_of(ROBOT, tmp_path)
    assert open_system(tmp_path / "robot.iprx").system == open_system(tmp_path / "robot.yaml").system
    lost = [each.message for each in result.findings if each.rule == "INC004"]
    assert "control: an executor of ROS 2 on the host has no place in an INCHRON project (2 times)" in "\n".join(lost)


def test_messages_of_the_host_that_come_more_often_than_stated_are_unknown_in_both(tmp_path):
    """Without the host, the controller would be analysed with the interval that it states."""
    project_of(ROBOT.replace("interval: 100 ms, jitter", "interval: 200 ms, jitter"), tmp_path)
    given, read = (verdicts(tmp_path / name) for name in ("robot.yaml", "robot.iprx"))
    assert given == read
    assert given[MESSAGE] is Verdict.UNKNOWN


@pytest.mark.parametrize(
    ("before", "after", "unknown"),
    [
        ("amuros {&quot;executor", "amuros {{&quot;executor", {"Spin"}),
        (r"&quot;interval&quot;:\d+", "&quot;interval&quot;:&quot;x&quot;", {"Spin"}),
        (r"&quot;spin&quot;:&quot;\w+", "&quot;spin&quot;:&quot;Nothing", {"Spin"}),
        (r"&quot;computer&quot;:&quot;pc", "&quot;computer&quot;:&quot;none", {"Spin", MESSAGE}),
        (r"&quot;release&quot;:&quot;humble", "&quot;release&quot;:&quot;none", {"Spin", MESSAGE}),
    ],
)
def test_what_cannot_be_used_makes_unknown_what_it_was_about(before, after, unknown, tmp_path):
    path = tmp_path / "robot.iprx"
    project_of(ROBOT, tmp_path)
    text, count = re.subn(before, after, path.read_text(), count=1)
    assert count == 1
    path.write_text(text)
    assert "INC008" in {each.rule for each in open_system(path).findings}
    found = verdicts(path)
    assert {name for name in unknown if found[name] is not Verdict.UNKNOWN} == set()
