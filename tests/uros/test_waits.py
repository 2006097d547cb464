"""Callbacks that wait for acknowledgements have no bound outside executors in loops, whether a wire is described or not.

The default of rmw_microxrcedds: `rmw_publish` of a reliable message returns when it is acknowledged, or after
RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT, 1000 ms (micro-ROS/rmw_microxrcedds, src/rmw_publish.c and CMakeLists.txt).
"""

from dataclasses import replace

import pytest

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.bridge.build import build_model
from amalthea_uros.bridge.extract import extract
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.network import Wait
from amalthea_uros.units import SECOND
from amalthea_uros.xmi.load import load
from amalthea_uros.xmi.save import save

TEXT = """
amuros: 1
name: app
hardware: {{platform: single-core, frequency: 100 MHz}}
middleware:
  executor: {{name: E, period: 5 ms, priority: {priority}, execution_time: {{base: 10 us}}, callbacks: {place}}}
  reliable: {{waits: {waits}}}
  transport: {{{transport}}}
application:
  nodes:
    - name: node
      publishers:
        - {{topic: odom, message_size: 8 B, reliability: {reliability}}}
      timers:
        - {{name: Control, period: 10 ms, priority: 2, execution_time: 4 us, publishes: [odom]}}
tasks:
  - {{name: Low, period: 20 ms, priority: 1, execution_time: 1 ms}}
chains:
  - {{name: effect, path: [E, Control], reaction: 20 ms}}
"""
IN_EXECUTOR, OWN_TASK = "in-executor", "own-task"
CAN = "can: {bitrate: 500 kbit/s}"


def assembly(author, place=OWN_TASK, transport="", waits="true", reliability="reliable"):
    priority = 2 if place == IN_EXECUTOR else 3
    text = TEXT.format(place=place, transport=transport, waits=waits, reliability=reliability, priority=priority)
    if place == IN_EXECUTOR:
        text = text.replace("name: Control, period: 10 ms, priority: 2", "name: Control, period: 10 ms")
    return author.describe(text)


@pytest.mark.parametrize("transport", ["", "acknowledgement: 20 ms", CAN])
@pytest.mark.parametrize(("place", "waiting", "met"), [(IN_EXECUTOR, "E", []), (OWN_TASK, "Control", ["E"])])
def test_who_waits_has_no_bound_although_no_wire_is_described(author, place, waiting, met, transport):
    system = assembly(author, place, transport).system
    assert system.network.waits == (Wait(runnable="Control_Callback", topic="odom", timeout=SECOND),)
    found = analyze_system(system)
    # Control and what it delays: only the executor above it is not concerned.
    assert [process.name for process in found.processes if process.verdict is Verdict.MET] == met
    assert "it waits up to 1 s for the acknowledgement of 'odom'" in found.processes[waiting].reason
    assert found.processes["Low"].response is None
    assert {requirement.verdict for requirement in found.requirements} == {Verdict.UNKNOWN}
    assert found.summary.schedulable == "unknown"


@pytest.mark.parametrize("place", [IN_EXECUTOR, OWN_TASK])
@pytest.mark.parametrize("harmless", [{"waits": "false"}, {"reliability": "best-effort"}])
def test_who_does_not_wait_has_a_bound(author, place, harmless):
    system = assembly(author, place, **harmless).system
    assert system.network.waits == ()
    # Nothing connects the executor to a task of its own, so that the chain between them is unknown, but no process is.
    assert {process.verdict for process in analyze_system(system).processes} <= {Verdict.MET, None}


def test_messages_on_a_bus_that_is_added_are_waited_for(author):
    found = assembly(author, transport=CAN)
    assert found.system_with_bus().network.waits == found.system.network.waits != ()


@pytest.mark.parametrize("transport", ["", "serial: {baud_rate: 115200}"])
def test_a_wait_is_told_once_by_executors_and_wires(author, transport):
    system = author.describe(
        f"""
        amuros: 1
        name: app
        hardware: {{platform: single-core, frequency: 100 MHz}}
        middleware:
          executor: {{name: E, loop: {{spin_some: 10 ms, sleep: 10 ms}}}}
          transport: {{{transport}}}
        application:
          nodes:
            - name: node
              publishers:
                - {{topic: odom, message_size: 8 B}}
              timers:
                - {{name: Inside, period: 100 ms, execution_time: 4 us, publishes: [odom]}}
                - {{name: Outside, period: 100 ms, execution_time: 4 us, publishes: [odom], runs_in: own-task}}
        """
    ).system
    assert [wait.runnable for wait in system.network.waits] == ([] if transport else ["Outside_Callback"])
    assert analyze_system(system).processes["Outside"].verdict is Verdict.UNKNOWN


def test_waits_come_back_from_a_model(author, tmp_path):
    system = assembly(author).system
    save(build_model(system), tmp_path / "model.amxmi")
    assert extract(load(tmp_path / "model.amxmi")).system.network == system.network


def test_a_network_that_cannot_be_read_makes_all_tasks_unknown(author, tmp_path):
    system = assembly(author).system
    lost = replace(system, network=replace(system.network, waits=(Wait(runnable="Gone", topic="odom"),)))
    save(build_model(lost), tmp_path / "model.amxmi")
    found = extract(load(tmp_path / "model.amxmi"))
    assert any(finding.rule == "EXT005" and "undefined runnable 'Gone'" in finding.message for finding in found.findings)
    results = analyze_system(found.system)
    assert all(process.verdict is not Verdict.MET for process in results.processes)
    assert results.summary.schedulable == "unknown"
