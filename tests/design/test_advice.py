"""Advice about latencies: each kind of change is recommended where it is the best one, and does in the file what is claimed."""

import json

import pytest
from click.testing import CliRunner
from effort import every
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.cli.main import cli
from amalthea_uros.services.explain import improvements
from amalthea_uros.services.init import catalogue, init_from_board

SAMPLES = ROOT / "samples"

ROVER = """\
amuros: 1
name: rover
hardware: {platform: nucleo-f446re}
os: {rtos: freertos, tick: 1 ms}
middleware:
  executor: {name: uros_task, loop: {spin_some: 1 ms, sleep: 1 ms}, execution_time: {base: 20 us}}
  transport: {serial: {baud_rate: 115200, driver: {write: blocking, read: blocking}}}
  agent: {to_controller: {min: 0, max: 1 ms}, to_host: {min: 0, max: 1 ms}}
application:
  nodes:
    - name: rover
      subscriptions:
        - name: On_Cmd
          topic: cmd
          rate: 20 Hz
          message_size: 12 B
          reliability: best-effort
          depth: 1
          execution_time: 50 us
          writes: [wanted]
      timers:
        - {name: Map, period: 500 ms, execution_time: 100 us}
tasks:
  - {name: Control, period: 1 ms, priority: 9, execution_time: 100 us, reads: [wanted], writes: [motor]}
chains:
  - {name: chain, path: [/cmd, On_Cmd, wanted, Control], reaction: LIMIT}
"""

#: A callback before the other one.
ON_MAP = """\
        - {name: On_Map, topic: map, rate: 2 Hz, message_size: 8 B, reliability: best-effort, depth: 1, execution_time: 3 ms}
"""

TASKS = """\
amuros: 1
name: app
hardware: {platform: generic, frequency: 100 MHz, cores: 2}
tasks:
  - {name: Video, core: Core_0, sporadic: {min: 40 ms, max: 50 ms}, priority: 9, deadline: 15500 us, execution_time: 15 ms}
  - {name: Read, period: 20 ms, core: Core_0, priority: 5, execution_time: 1 ms, writes: [x]}
  - {name: Write, period: 1 ms, core: Core_1, priority: 6, execution_time: 100 us, reads: [x], writes: [y]}
chains:
  - {name: chain, path: [Read, x, Write], from: activation, reaction: LIMIT}
"""

PHASES = """\
amuros: 1
name: app
hardware: {platform: generic, frequency: 100 MHz}
middleware: {task_periods: [10 ms]}
tasks:
  - {name: Read, period: 10 ms, offset: 1 ms, priority: 5, execution_time: 1 ms, writes: [x]}
  - {name: Write, period: 10 ms, offset: 0 ms, priority: 6, execution_time: 1 ms, reads: [x], writes: [y]}
chains:
  - {name: chain, path: [Read, x, Write], from: activation, reaction: LIMIT}
"""

#: A state that is published reliably, in the iteration before that of a command.
STATE = (
    ROVER.replace("115200", "921600")
    .replace("to_host: {min: 0, max: 1 ms}", "to_host: {min: 0, max: 1 ms}, acknowledgement: {min: 0, max: 5 ms}")
    .replace("      timers:", "      publishers: [{topic: odom, message_size: 100 B, reliability: reliable}]\n      timers:")
    .replace("execution_time: 100 us}\ntasks", "execution_time: 100 us, publishes: [odom]}\ntasks")
)

#: Another executor, which keeps the session of the middleware while it waits for commands.
TWO_EXECUTORS = (
    STATE.replace("reliability: reliable", "reliability: best-effort")
    .replace(
        "  executor: {name: uros_task, loop: {spin_some: 1 ms, sleep: 1 ms}, execution_time: {base: 20 us}}\n",
        "  multithread: true\n  executors:\n"
        "    - {name: commands, priority: 5, loop: {spin_some: 100 ms, sleep: 1 ms}, execution_time: {base: 20 us}}\n"
        "    - {name: states, priority: 4, loop: {spin_some: 1 ms, sleep: 1 ms}, execution_time: {base: 20 us}}\n",
    )
    .replace("- name: On_Cmd\n", "- name: On_Cmd\n          runs_in: commands\n")
    .replace("{name: Map, period: 500 ms,", "{name: Map, period: 500 ms, runs_in: states,")
    .replace("[/cmd, On_Cmd, wanted, Control]", "[Map, /odom]")
)

#: What is large in a description -> its text, with a limit, and the change that is enough: as an option, and as an edit of the text.
CASES = {
    "a long callback before it": (
        ROVER.replace("loop: {spin_some: 1 ms, sleep: 1 ms}", "period: 5 ms, callbacks: in-executor")
        .replace("115200", "921600")
        .replace("subscriptions:\n", f"subscriptions:\n{ON_MAP}")
        .replace("LIMIT", "10 ms"),
        "On_Map.runs_in=own-task",
        ("execution_time: 3 ms}", "execution_time: 3 ms, runs_in: own-task}"),
    ),
    "a long sleep": (
        ROVER.replace("115200", "921600").replace("sleep: 1 ms", "sleep: 10 ms").replace("LIMIT", "10 ms"),
        "uros_task.sleep=1ms",
        ("sleep: 10 ms", "sleep: 1 ms"),
    ),
    "a long period of the loop": (
        ROVER.replace("115200", "921600")
        .replace("{spin_some: 1 ms, sleep: 1 ms}", "{spin_period: 20 ms, timeout: 1 ms}")
        .replace("LIMIT", "10 ms"),
        "uros_task.spin_period=1ms",
        ("spin_period: 20 ms", "spin_period: 1 ms"),
    ),
    "a long wait of another executor": (
        TWO_EXECUTORS.replace("LIMIT", "20 ms"),
        "commands.spin_some=1ms",
        ("spin_some: 100 ms", "spin_some: 1 ms"),
    ),
    "an acknowledgement": (
        STATE.replace("LIMIT", "10 ms"),
        "odom.reliability=best-effort",
        ("reliability: reliable", "reliability: best-effort"),
    ),
    "a driver that asks in each tick": (
        ROVER.replace("115200", "921600")
        .replace("read: blocking", "read: dma")
        .replace("sleep: 1 ms", "sleep: 2 ms")
        .replace("LIMIT", "7 ms"),
        "driver.read=blocking",
        ("read: dma", "read: blocking"),
    ),
    "a timer": (
        ROVER.replace("execution_time: 100 us}\ntasks", "execution_time: 100 us, reads: [wanted]}\ntasks")
        .replace("wanted, Control]", "wanted, Map]")
        .replace("LIMIT", "300 ms"),
        "Map.period=250ms",
        ("period: 500 ms", "period: 250 ms"),
    ),
    "a long tick": (
        ROVER.replace("tick: 1 ms", "tick: 10 ms").replace("LIMIT", "12 ms"),
        "os.tick=1ms",
        ("tick: 10 ms", "tick: 1 ms"),
    ),
    "a long message": (
        ROVER.replace("115200", "921600").replace("message_size: 12 B", "message_size: 500 B").replace("LIMIT", "12 ms"),
        "On_Cmd.message_size=250B",
        ("message_size: 500 B", "message_size: 250 B"),
    ),
    "a slow serial line": (ROVER.replace("LIMIT", "8 ms"), "serial.baud_rate=921600", ("115200", "921600")),
    "a slow bus": (
        ROVER.replace("serial: {baud_rate: 115200, driver: {write: blocking, read: blocking}}", "can: {bitrate: 125 kbit/s}")
        .replace("nucleo-f446re", "bodas-rc18-12-40")
        .replace("os: {rtos: freertos, tick: 1 ms}\n", "")
        .replace("LIMIT", "8 ms"),
        "can.bitrate=1 Mbit/s",
        ("125 kbit/s", "1 Mbit/s"),
    ),
    "another task on its core": (
        TASKS.replace("LIMIT", "23 ms"),
        "Read.core=Core_1",
        ("Read, period: 20 ms, core: Core_0", "Read, period: 20 ms, core: Core_1"),
    ),
    "a wait for the next job": (PHASES.replace("LIMIT", "13 ms"), "Write.offset=2ms", ("offset: 0 ms", "offset: 2 ms")),
}


@pytest.mark.parametrize("what", every(4, list(CASES)))
def test_what_helps_most_is_recommended_and_is_enough_in_the_edited_file(what):
    text, option, (old, new) = CASES[what]
    assert text.count(old) == 1
    best = improvements(text, "chain").recommended
    assert best.change.options == ("--set", option)
    edited = amuros.analyze(text.replace(old, new))
    assert best.after == edited.chains["chain"].worst < amuros.analyze(text).chains["chain"].worst
    assert best.is_enough
    assert edited.summary.schedulable is amuros.Schedulable.YES


def test_a_task_of_its_own_that_is_not_proved_is_none_to_recommend():
    """Iterations may follow each other after 20 us, so that nothing shows that the other task has time for 40 ms after each."""
    text = ROVER.replace("execution_time: 100 us}\ntasks", "execution_time: 40 ms}\ntasks").replace("LIMIT", "20 ms")
    found = improvements(text, "chain")
    (alone,) = [each for each in found.found if each.change.options == ("--set", "Map.runs_in=own-task")]
    assert (alone.is_enough, alone.is_safe) == (True, False)
    assert [(each.name, each.before, each.after) for each in alone.drawbacks] == [("Map", "no task", "unknown")]
    edited = amuros.analyze(text.replace("execution_time: 40 ms}", "execution_time: 40 ms, runs_in: own-task}"))
    assert edited.processes["Map"].verdict is amuros.Verdict.UNKNOWN
    assert found.recommended is None or "runs_in" not in found.recommended.change.text


@pytest.mark.parametrize("text", [PHASES.replace("LIMIT", "13 ms"), TASKS.replace("LIMIT", "23 ms")])
def test_logical_execution_times_are_no_advice(text):
    """With LET, a job reads as early and writes as late as it can, so that no chain is shorter; it makes times alike."""
    let = amuros.Settings(communication=amuros.Communication.LET)
    assert amuros.analyze(text, let).chains["chain"].worst > amuros.analyze(text).chains["chain"].worst
    assert all("let" not in each.change.text.lower() for each in improvements(text, "chain").found)


#: Where improvements are proposed: the templates of boards, the samples, and a model.
FILES = [
    *reversed([board.name for board in catalogue().boards]),
    *(path.name for path in sorted(SAMPLES.glob("*.yaml"))),
    "bodas-test-advanced.amxmi",
]


@pytest.mark.parametrize("name", every(len(FILES), FILES))
def test_each_proposal_gives_as_a_command_what_it_claims(name, tmp_path):
    path = SAMPLES / name
    if not path.exists():
        path = tmp_path / "app.yaml"
        init_from_board(path, name)
    result = amuros.analyze_files(path)
    for chain in result.system.chains:
        for each in every(2, improvements(result, chain).found):
            run = CliRunner().invoke(cli, ["analyze", str(path), *each.change.options, "--chain", chain, "--output", "json"])
            (shown,) = [found for found in json.loads(run.stdout)["chains"] if found["name"] == chain]
            values = {value["quantity"]: (value["value_ps"], value["claim"]) for value in shown["values"]}
            assert values["max_reduced_reaction_time"] == (each.after, str(each.claim)), each.change.text
