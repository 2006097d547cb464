"""docs/json against the JSON of all commands: the pages have every field, nothing else, and the right types."""

import json
import re
import shutil
from collections.abc import Iterator
from functools import cache
from typing import Any, NamedTuple

import pytest
from command import amuros
from support import ROOT

from amalthea_uros import am, load, save
from amalthea_uros.report.formats import formats_for

PAGES = ROOT / "docs" / "json"
TYPES = {"text": str, "integer": int, "number": (int, float), "boolean": bool, "object": dict, "null": type(None)}
ADVANCED = "bodas-test-advanced.yaml"

#: Section -> commands whose results, all together, have each of its fields.
RUNS = {
    "amuros analyze": (
        (
            *("analyze", ADVANCED, "--phase", "Message_Factor=0ms"),
            *("--sensitivity", "--assign-priorities", "--explain", "Executor_Task"),
        ),
        ("analyze", ADVANCED, "--phase", "Message_Factor=0ms", "--explain", "factor-to-output", "--method", "all"),
        ("analyze", ADVANCED, "--explain", "Control_Function"),
        ("analyze", ADVANCED, "--scale", "80", "--explain", "Control_Function"),
        ("analyze", "rclc-in-executor.yaml", "--explain", "On_Command_Callback"),
        ("analyze", "unknown.amxmi", "--explain", "Empty"),
        ("analyze", "arduino.yaml", "--explain", "Control_Callback"),
        ("analyze", "rclc-in-executor.yaml", "--explain", "rclc_executor"),
        ("analyze", "drive-and-lift.yaml", "--explain", "valve-to-log"),
        ("analyze", "two-controllers-lift.yaml", "--explain", "goal-to-valve"),
        ("analyze", ADVANCED, "--set", "Message_Factor.period=10ms"),
        ("analyze", "unknown.amxmi", "--set", "Control_Function.execution_time=500us"),
        ("analyze", "no-times.amxmi", "--set", "Control_Function.execution_time=500us"),
        ("analyze", "way.yaml"),
        ("analyze", "open.amxmi"),
        ("analyze", "host.yaml"),
    ),
    "amuros simulate": (
        ("simulate", ADVANCED, "--duration", "100ms", "--labels", "all"),
        ("simulate", "unknown.amxmi", "--duration", "20ms"),
        ("simulate", "robot-xrce.yaml", "--duration", "200ms"),
        ("simulate", "lossy.yaml", "--duration", "2s"),
        ("simulate", ADVANCED, "--duration", "20ms", "--set", "Control_Function.execution_time=40us"),
        (
            "simulate",
            ADVANCED,
            "--duration",
            "20ms",
            "--sweep",
            "Message_Factor.phase=0ms,5ms",
            "--set",
            "Control_Function.period=2ms",
        ),
    ),
    "amuros sweep": (
        (
            "sweep",
            "bodas-test-advanced.amxmi",
            "--sweep",
            "Control_Function.execution_time=4us,2ms",
            "--set",
            "Control_Function.period=2ms",
        ),
        ("sweep", "unknown.amxmi", "--sweep", "Control_Function.execution_time=4us,5us", "--sample", "1"),
    ),
    "amuros measure": (
        ("measure", "bodas-test-measured.log", "--markers", "bodas-test-measured.markers.yml"),
        ("measure", "bodas-test-measured.log", "--start", "18000001", "--end", "18000002", "--from", "10ms"),
        ("measure", "bodas-test-measured.log", "--start", "18000001", "--end", "1"),
    ),
    "amuros compare": (
        ("compare", ADVANCED, "stopwatch.csv", "--duration", "20ms", "--set", "Control_Function.execution_time=5us"),
        ("compare", "bodas-test-simple.yaml", "stopwatch.csv", "--by", "analysis"),
        ("compare", "counted.amxmi", "stopwatch.csv", "--by", "analysis"),
        ("compare", ADVANCED, "rtt.csv", "--column", "rtt_ms=factor-to-output", "--duration", "20ms"),
    ),
    "amuros optimize": (
        (
            *(
                "optimize",
                ADVANCED,
                "--limit",
                "factor-to-output.max_reduced_reaction_time<11ms",
                "--limit",
                "Core_0.load<=50%",
            ),
            *("--offer", "Executor_Task.period=1ms,2ms"),
        ),
    ),
    "amuros check": (("check", ADVANCED, "--profile", "inchron,ta"),),
    "amuros build": (
        ("build", "bodas-test-hardware.yaml", "-o", "built.amxmi"),
        ("build", "drive-and-lift.yaml", "-o", "too.amxmi"),
        ("build", "loops.yaml", "-o", "loops.amxmi"),
        ("build", "stacks.yaml", "-o", "stacks.amxmi"),
    ),
    "amuros generate": (
        ("generate", "drive-and-lift.yaml", "-o", "firmware"),
        ("generate", "stacks.yaml", "-o", "firmware"),
        ("generate", "rclc-in-executor.yaml", "--check", "wrong.meta"),
    ),
    "amuros calibrate": (
        ("calibrate", "bodas-test-measured.yaml", "bodas-test-measured.log", "--markers", "bodas-test-measured.markers.yml"),
    ),
    "amuros diff": (
        ("diff", "bodas-test-advanced.amxmi", "bodas-test-simple.amxmi", "--impact"),
        ("diff", ADVANCED, "bodas-test-simple.yaml"),
    ),
    "amuros migrate": (("migrate", "pump-1.2.0.amxmi", "-o", "migrated.amxmi"),),
    "amuros info": (("info", "bodas-test-hardware.amxmi"), ("info", "pump-1.2.0.amxmi")),
    "amuros rules": (("rules", "TIM"),),
}

#: Sections of types -> the section whose runs have each of their fields.
SHARED = {
    "finding": "amuros check",
    "metric": "amuros analyze",
    "observation": "amuros simulate",
    "statistics": "amuros measure",
    "change": "amuros analyze",
    "impact": "amuros analyze",
}

#: A timer that can skip periods.
HOST = """
amuros: 1
name: host
hardware: host
host:
  ros: humble
  computers: [{name: pc}]
  executors: [{name: main, thread: {policy: fifo, priority: 1}}]
  nodes:
    - name: node
      executor: main
      timers:
        - {name: Fast, period: 10 ms, execution_time: 1 ms}
        - {name: Slow, period: 100 ms, execution_time: 20 ms}
"""

Place = tuple[str, ...]


class Field(NamedTuple):
    path: Place
    types: tuple[str, ...]
    shared: str = ""

    def holds(self, path: Place) -> bool:
        return len(path) == len(self.path) and all(mine in ("*", key) for mine, key in zip(self.path, path, strict=True))


def rows(section: str) -> Iterator[Field]:
    """The fields of a section; those of a type that has a section of its own instead of it."""
    if section in SHARED:
        text = (PAGES / "shared.md").read_text().partition(f"\n## {section}\n")[2].partition("\n## ")[0]
    else:
        text = (PAGES / f"{section.removeprefix('amuros ')}.md").read_text()
    for names, kinds in re.findall(r"^\| (`.+?) \| (.+?) \|", text, re.MULTILINE):
        types = tuple(re.split(", | or ", kinds))
        for name in re.findall(r"`([^`]+)`", names):
            yield from expanded(tuple(name.replace("[]", ".[]").split(".")), types)


def expanded(path: Place, types: tuple[str, ...]) -> Iterator[Field]:
    plain = tuple(kind for kind in types if not kind.startswith("["))
    if plain:
        yield Field(path, plain)
    for kind in set(types) - set(plain):
        shared = kind[1:].partition("]")[0]
        yield from (Field(path + field.path, field.types, shared) for field in rows(shared))


def values(found: Any, path: Place = ()) -> Iterator[tuple[Place, Any]]:
    """The places of a result, and what is there; lists and objects are looked into."""
    if isinstance(found, list):
        for item in found:
            yield from values(item, (*path, "[]"))
    elif isinstance(found, dict):
        for key, item in found.items():
            yield from values(item, (*path, key))
    else:
        yield path, found


WAY = """
amuros: 1
name: way
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {name: Executor, loop: {spin_some: 100 ms, sleep: 10 ms}, execution_time: 10 us}
  transport: {serial: {baud_rate: 115200}}
  agent: {to_controller: 1 ms}
application:
  nodes:
    - name: node
      subscriptions: [{name: drive, topic: cmd_vel, rate: 4 Hz, message_size: 48 B, execution_time: 100 us}]
chains: [{name: cmd, path: [/cmd_vel, drive]}]
"""
LOOPS = """
amuros: 1
name: loops
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  multithread: true
  executors:
    - {name: Fast, loop: {spin_some: 10 ms, sleep: 1 ms}}
    - {name: Slow, loop: {spin_period: 20 ms, timeout: 5 ms}}
application:
  nodes:
    - name: node
      subscriptions: [{name: On_Command, topic: command, rate: 20 Hz, message_size: 8 B, execution_time: 4 us}]
      timers: [{name: Control, period: 40 ms, execution_time: 4 us, runs_in: Slow}]
      guard_conditions: [{name: Stop, execution_time: 4 us}]
"""

#: A loop whose sleep is longer than the period of its timer.
ARDUINO = """
amuros: 1
name: robot
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {loop: {spin_some: 100 ms, sleep: 100 ms}, execution_time: {base: 12 us}}
application:
  nodes:
    - name: node
      subscriptions: [{name: On_Command, topic: command, rate: 5 Hz, message_size: 8 B, execution_time: 4 us}]
      timers: [{name: Control, period: 10 ms, execution_time: 4 us}]
"""


@pytest.fixture
def folder(tmp_path):
    for path in (ROOT / "samples").iterdir():
        if path.is_file():
            shutil.copy(path, tmp_path)
    model = load(tmp_path / "bodas-test-advanced.amxmi")
    limit = am.TimeRequirementLimit(
        limit_type=am.LimitType.UPPER_LIMIT, metric=am.TimeMetric.RESPONSE_TIME, limit_value=am.Time(1, "ms")
    )
    runnable = model[am.Runnable, "Control_Function_Callback"]
    model.root.constraints_model.requirements.append(am.RunnableRequirement(name="callback", runnable=runnable, limit=limit))
    model.root.sw_model.tasks.append(am.Task(name="Empty", stimuli=[model[am.Task, "Control_Function"].stimuli[0]]))
    save(model, tmp_path / "unknown.amxmi")
    model[am.Runnable, "Message_Factor_Callback"].activity_graph = None
    save(model, tmp_path / "no-times.amxmi")
    count = am.CountRequirementLimit(limit_type=am.LimitType.UPPER_LIMIT, metric=am.CountMetric.PREEMPTIONS, limit_value=1)
    process = model[am.Task, "Control_Function"]
    model.root.constraints_model.requirements.append(am.ProcessRequirement(name="preemptions", process=process, limit=count))
    save(model, tmp_path / "counted.amxmi")
    (tmp_path / "way.yaml").write_text(WAY)
    (tmp_path / "host.yaml").write_text(HOST)
    (tmp_path / "lossy.yaml").write_text(WAY.replace("transport: {", "transport: {losses: 1 per 1 s, "))
    (tmp_path / "loops.yaml").write_text(LOOPS)
    (tmp_path / "arduino.yaml").write_text(ARDUINO)
    # Nothing activates the tasks.
    (tmp_path / "open.amxmi").write_text(re.sub(' stimuli="[^"]*"', "", (tmp_path / "executor.amxmi").read_text()))
    rclc = (tmp_path / "rclc-in-executor.yaml").read_text()
    (tmp_path / "stacks.yaml").write_text(rclc.replace("  executor:\n", "  executor:\n    stack: 16 kB\n"))
    (tmp_path / "wrong.meta").write_text('{"names": {"rmw_microxrcedds": {"cmake-args": ["-DRMW_UXRCE_MAX_NODES=0"]}}}')
    (tmp_path / "rtt.csv").write_text("rtt_ms\n10\nnan\n")
    (tmp_path / "stopwatch.csv").write_text(
        "object,kind,quantity,value_us\nControl_Function,process,response_time,16\nControl_Function,process,response_time,1200\n"
    )
    return tmp_path


@pytest.mark.early
@pytest.mark.parametrize("section", RUNS)
def test_a_command_writes_the_fields_of_the_page(section, folder):
    fields = [Field(("amuros",), ("text",)), *rows(section)]
    unseen = {field.path for field in fields if "object" not in field.types and SHARED.get(field.shared, section) == section}
    # A result has the same places in many objects.
    matching_at = cache(lambda path: [field for field in fields if field.holds(path)])
    for number, command in enumerate(RUNS[section]):
        file = folder / f"{number}.json"
        amuros(*command, "--output", f"json={file}", cwd=folder)
        for path, value in values(json.loads(file.read_text())):
            matching = matching_at(path)
            assert matching, f"docs/json lacks {show(path)} in '{section}'"
            allowed = tuple(TYPES[kind] for field in matching for kind in field.types)
            assert any(isinstance(value, kind) for kind in allowed), f"{show(path)} is {value!r}"
            assert not isinstance(value, bool) or bool in allowed, f"{show(path)} is {value!r}"
            unseen -= {field.path for field in matching}
    assert not unseen, f"nothing writes {', '.join(map(show, sorted(unseen)))}"


def test_every_command_with_json_has_a_page():
    texts = [path.read_text() for path in (ROOT / "amalthea_uros" / "cli").glob("*.py")]
    commands = [part for text in texts for part in text.split('@click.command("')[1:]]
    results = {part.partition('"')[0]: re.search(r'@output_option\("(\w+)"', part.partition("\ndef ")[0]) for part in commands}
    with_json = {command for command, result in results.items() if result and "json" in formats_for(result[1])}
    assert with_json == {section.removeprefix("amuros ") for section in RUNS}


def show(path: Place) -> str:
    return ".".join(path).replace(".[]", "[]")
