"""The latency of messages, end to end, has one answer in all outputs; and none where something is not stated."""

import json
import re

import pytest
from command import amuros

from amalthea_uros import analyze_files, simulate
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Rounding, rounded_time_text
from amalthea_uros.uros.described import describe_text

BOARD = """
amuros: 1
name: robot
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor:
    name: Executor
    loop: {spin_some: 100 ms, sleep: 10 ms}
    execution_time: {base: 100 us, per_handle: 5 us, per_message: 50 us}
  transport: {serial: {baud_rate: 115200, interrupt: {name: Receive, execution_time: 10 us}}}
  agent: {to_controller: {min: 0, max: 2 ms}, to_host: {min: 0, max: 2 ms}, acknowledgement: {min: 0, max: 2 ms}}
application:
  nodes:
    - name: robot
      publishers: [{topic: wheel_speed, message_size: 8 B, reliability: reliable}]
      subscriptions:
        - {name: On_Command, topic: cmd_vel, rate: 2 Hz, message_size: 48 B, execution_time: 60 us, writes: [command], depth: 1,
           reliability: best-effort}
      timers:
        - {name: Control, period: 100 ms, execution_time: 450 us, reads: [command], writes: [motor], publishes: [wheel_speed]}
chains:
  - {name: to-motor, path: [cmd_vel, On_Command, Control, motor], reaction: 2 s}
  - {name: to-host, path: [cmd_vel, On_Command, Control, wheel_speed], reaction: 2 s}
requirements:
  - {process: On_Command, response_time: 1 s}
"""


@pytest.fixture
def app(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text(BOARD.lstrip())
    return path


def changed(old, new):
    assert old in BOARD
    return BOARD.replace(old, new)


def test_a_path_ends_with_the_label_that_its_last_callback_writes():
    analysis = analysis_of(BOARD)
    way = analysis.chains["to-motor"]
    assert (way.start, way.end) == ("/cmd_vel", "motor")
    # Whether it writes before or after it publishes is not stated: the worst case is the end of the callback.
    last = analysis.executors["Executor"].handles["Control"].response.worst
    assert way.hops[-1].worst == last + 100 * MS


def test_a_label_that_the_last_member_does_not_write():
    (finding,) = (
        each for each in described("On_Command, Control, motor]", "Control, On_Command, motor]") if "write" in each.message
    )
    assert (finding.rule, finding.message) == ("UR130", "'On_Command' does not write 'motor'")


def described(old, new):
    return describe_text(changed(old, new)).assembly.findings


def analysis_of(text):
    return analyze_system(describe_text(text).assembly.system)


def test_the_worst_latency_is_the_same_everywhere(app, tmp_path):
    """Text, JSON, report, explanation and library: as picoseconds, or as the text for them."""
    analysis = analyze_files(app).analysis
    way = analysis.chains["to-host"]
    assert analysis.requirements["to-host_reaction"].value == way.worst
    assert way.worst in {value.value for value in way.values}
    run = amuros("analyze", app, "--output", "text", "--output", f"json={tmp_path / 'analysis.json'}")
    shown = re.search(r"to-host +/cmd_vel +/wheel_speed +\S+ \S+ +(\S+ ms)", run.stdout).group(1)
    assert abs(float(shown.split()[0]) * 1e9 - way.worst) < 1e8
    document = json.loads((tmp_path / "analysis.json").read_text())
    (found,) = (each for each in document["chains"] if each["name"] == "to-host")
    assert sum(hop["worst_ps"] for hop in found["hops"]) == way.worst
    assert rounded_time_text(way.worst, Rounding.UP) in amuros("analyze", app, "--explain", "to-host").stdout.splitlines()[0]
    amuros("report", app, "--no-simulation", "-o", tmp_path / "report.md")
    assert shown in (tmp_path / "report.md").read_text()


#: What is taken away, and what the cause of the verdict names.
UNSTATED = {
    "agent": ("to_controller: {min: 0, max: 2 ms}, ", "", "to_controller", "to-motor"),
    "to host": ("to_host: {min: 0, max: 2 ms}, ", "", "to_host", "to-host"),
}


@pytest.mark.parametrize("case", UNSTATED)
def test_what_nobody_stated_is_never_met(case):
    old, new, key, chain = UNSTATED[case]
    analysis = analysis_of(changed(old, new))
    requirement = analysis.requirements[f"{chain}_reaction"]
    assert (requirement.verdict, analysis.chains[chain].worst) == ("unknown", None)
    assert key in requirement.reason


def test_callbacks_are_unknown_if_nobody_stated_how_much_their_messages_vary_in_the_agent():
    analysis = analysis_of(changed(*UNSTATED["agent"][:2]))
    (executor,) = analysis.executors
    assert executor.handles["On_Command"].response.worst is None
    (requirement,) = (each for each in analysis.requirements if not each.name.endswith("_reaction"))
    assert requirement.verdict == "unknown"
    assert any("middleware.agent.to_controller" in finding.message for finding in analysis.findings)


def test_a_simulation_observes_loops():
    simulation = simulate(BOARD, "1 s")
    assert {each.verdict for each in simulation.requirements} == {"observed_ok"}
    assert all(chain.observations for chain in simulation.chains)
    assert simulation["Executor"].jobs == simulation.executors["Executor"].iterations


def test_messages_in_paths_are_no_gaps(app):
    assert "TIM-CHAIN-CARRIED" not in amuros("check", app).stdout
